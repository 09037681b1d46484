"""Dry friction grows with a measured current: what yields in a magnetic or electric field."""

from ident.effects.effect import Effect
from ident.effects.needs import force_answers
from ident.parameter import Parameter

CURRENT_FRICTION = Effect(
    name="current_friction",
    place="load",
    meaning="dry friction in proportion to the measured current or voltage of a coil, which follows it by a lag",
    strength=Parameter("force", "Fi", "N", 0.0, 1e5, 0.0, "dry friction for each unit of the current"),
    texts=("Ff = Ff + Fi * lag(abs(current), Ti)",),
    units={"Ff": "N"},
    shape=(Parameter("lag", "Ti", "s", 1e-4, 1.0, 1e-2, "time constant of the field"),),
    looks="flat tops that are wider while the current is high",
    source="Bingham model of a magnetorheological damper; Spencer, Dyke, Sain and Carlson 1997",
    steps=2,
    needs=force_answers,
)

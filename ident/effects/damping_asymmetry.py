"""Damping of one direction is larger than that of the other."""

from ident.effects.effect import Effect
from ident.effects.needs import force_answers
from ident.parameter import Parameter

DAMPING_ASYMMETRY = Effect(
    name="damping_asymmetry",
    place="load",
    meaning="damping is larger in one direction than in the other",
    strength=Parameter(
        "coefficient", "ca", "N*s/m", -2e4, 2e4, 0.0, "half of the difference of the damping, forward less back"
    ),
    texts=("R = R + ca * abs(v)",),
    units={"R": "N"},
    looks="the force over the speed has another slope on either side of zero",
    source="check valves of a damper that open one way: compression and rebound",
    needs=force_answers,
)

"""A load on the link grows with its position."""

from ident.effects.effect import Effect
from ident.parameter import Parameter, Starts

SPRING_LOAD = Effect(
    name="spring_load",
    place="load",
    meaning="a spring loads the link, so the speed depends on the position",
    strength=Parameter(
        "rate",
        "cF",
        "Pa/m",
        -1e9,
        1e9,
        0.0,
        "pressure difference per metre of position",
        start=Starts.FRICTION_GRADIENT,
    ),
    texts=("Pn = Pn + s * cF * (x - x0)",),
    shape=(Parameter("centre", "x0", "m", -1.0, 1.0, 0.0, "position at which the load is zero", of_motion=True),),
    units={"Pn": "Pa"},
    looks="a speed that depends on the position; a zero shift for each range of positions",
    source="hinge moment of a control surface; a spring that loads the link",
)

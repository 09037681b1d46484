"""The transducer's curve bends to one side."""

from ident.effects.effect import Effect
from ident.effects.needs import one_sided_position
from ident.parameter import Parameter

SENSOR_CURVE = Effect(
    name="sensor_curve",
    place="sensor",
    meaning="the characteristic of the recorded displacement is curved, to one side of zero only",
    strength=Parameter(
        "curvature", "c", "1/m", -10.0, 10.0, 0.0, "relative error for each metre of reading", of_motion=True
    ),
    texts=("y = y * (1 + c * y)",),
    units={"y": "m"},
    looks="a gain that changes with the level; in open loop the dynamics do not change",
    source="terminal-based linearity of a level or pressure gauge, its second-order term",
    needs=one_sided_position,
)

"""The transducer's curve bends to one side."""

from ident.effects.effect import Effect
from ident.effects.needs import one_sided_position
from ident.parameter import Parameter

SENSOR_CURVE = Effect(
    name="sensor_curve",
    place="sensor",
    meaning="the recorded displacement bends away from a straight line, to one side of zero",
    strength=Parameter(
        "curvature", "c", "1/m", -10.0, 10.0, 0.0, "relative error for each metre of reading", of_motion=True
    ),
    texts=("y = y * (1 + c * y)",),
    units={"y": "m"},
    looks="a gain that changes with the level, in open loop without a change of dynamics",
    source="terminal-based linearity of a level or pressure gauge, its second-order term",
    needs=one_sided_position,
)

"""The opening saturates."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

FLOW_SATURATION = Effect(
    name="flow_saturation",
    place="spool",
    meaning="the flow saturates at large openings of the valve",
    does="a speed that saturates",
    strength=Parameter(
        "inverse_opening", "a", "1/m", 0.0, 300.0, 0.0, "inverse of the opening at which the flow saturates"
    ),
    texts=("w = w / sqrt(1 + (a * w)**2)",),
    units={"w": "m"},
    looks="less bandwidth at large amplitudes and gains; rounded peaks of speed",
    source="Kononykhin, speed characteristic",
)

"""The recorded displacement is scaled wrongly, outside the loop."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

SENSOR_GAIN = Effect(
    name="sensor_gain",
    place="sensor",
    meaning="the recorded displacement has a wrong scale, outside the loop",
    strength=Parameter("error", "g", "1", -0.1, 0.1, 0.0, "relative error of the recorded displacement"),
    texts=("y = y * (1 + g)",),
    units={"y": "m"},
    looks="the static gain is not 1, by the same factor in all runs",
    source="calibration",
)

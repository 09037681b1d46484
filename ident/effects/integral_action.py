"""The controller also integrates the error."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

INTEGRAL_ACTION = Effect(
    name="integral_action",
    place="controller",
    meaning="the controller also integrates the error",
    strength=Parameter("gain", "Ki", "1/s", 0.0, 50.0, 0.0, "integral gain"),
    texts=(
        "i' = r - y_in",
        "e = e + Kp * Ki * i",
    ),
    units={"e": "m"},
    looks="peaking at low frequency, no mean error whatever the bias; phase lag below a few hertz",
    source="PI control",
)

"""The controller also integrates the error."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

INTEGRAL_ACTION = Effect(
    name="integral_action",
    place="controller",
    meaning="the controller has integral action, too",
    strength=Parameter("gain", "Ki", "1/s", 0.0, 50.0, 0.0, "integral gain"),
    texts=(
        "i' = r - y_in",
        "e = e + Kp * Ki * i",
    ),
    units={"e": "m"},
    looks="a resonance peak at low frequency, no mean error with any bias; phase lag below a few hertz",
    source="PI control",
)

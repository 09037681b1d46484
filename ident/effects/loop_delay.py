"""The controller sees the position late."""

from ident.effects.effect import Effect
from ident.parameter import Parameter, Starts

LOOP_DELAY = Effect(
    name="loop_delay",
    place="controller",
    meaning="the position feedback has a delay",
    strength=Parameter("delay", "T", "s", 0.0, 3e-3, 0.0, "delay of the position in the controller", start=Starts.TIME),
    texts=(
        "y_in = delay(y_in, T)",
        "v_in = delay(v_in, T)",
    ),
    units={"y_in": "m", "v_in": "m/s"},
    looks="less damping at high gain, hardly any at low gain; more phase lag at high gain",
    source="sampled controllers; in the loop as a second-order Padé approximant",
)

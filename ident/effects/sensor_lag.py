"""The transducer lags, inside the loop."""

from ident.effects.effect import Effect
from ident.parameter import Parameter, Starts

SENSOR_LAG = Effect(
    name="sensor_lag",
    place="sensor",
    meaning="the transducer has a lag, inside the loop",
    strength=Parameter("time_constant", "T", "s", 0.0, 3e-3, 0.0, "time constant of the transducer", start=Starts.TIME),
    texts=(
        "y_fb = lag(y_fb, T)",
        "v_fb = lag(v_fb, T)",
    ),
    units={"y_fb": "m", "v_fb": "m/s"},
    looks="less damping at high gain; the record lags the motion",
    source="transducer and conditioner",
)

"""The recorded displacement lags what the controller sees."""

from ident.effects.effect import Effect
from ident.parameter import Parameter, Starts

ACQUISITION_LAG = Effect(
    name="acquisition_lag",
    place="sensor",
    meaning="the recorded displacement lags the displacement in the controller",
    strength=Parameter("time_constant", "T", "s", 0.0, 3e-3, 0.0, "time constant of the recorder", start=Starts.TIME),
    texts=("y = lag(y, T)",),
    units={"y": "m"},
    looks="the same phase lag at every gain and specimen, and a little less magnitude",
    source="anti-aliasing filter of the recorder",
)

"""The recorded speed lags the speed."""

from ident.effects.effect import Effect
from ident.effects.needs import speed_measured
from ident.parameter import Parameter, Starts

SPEED_SENSOR_LAG = Effect(
    name="speed_sensor_lag",
    place="sensor",
    meaning="the recorded speed lags the speed: a filter, or a counter that counts over a while",
    strength=Parameter(
        "time_constant", "T", "s", 0.0, 3e-3, 0.0, "time constant of the speed sensor", start=Starts.TIME
    ),
    texts=("vy = lag(vy, T)",),
    units={"vy": "m/s"},
    looks="phase lag and a little less magnitude towards high frequencies, the same at every amplitude",
    source="filter of a tachometer; gate time of a pulse counter, whose mean is late by half of it",
    needs=speed_measured,
)

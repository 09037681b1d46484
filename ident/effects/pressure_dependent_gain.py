"""The flow gain changes with the load pressure, alike in both directions."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

PRESSURE_DEPENDENT_GAIN = Effect(
    name="pressure_dependent_gain",
    place="flow",
    meaning="the flow gain changes with the magnitude of the load pressure, in both directions alike",
    does="a gain that changes with the load",
    strength=Parameter(
        "slope", "g", "1/Pa", -5e-7, 5e-7, 0.0, "relative change of the flow gain for each pascal of load pressure"
    ),
    texts=("Q = Q * (1 + g * abs(P))",),
    units={"Q": "m^3/s"},
    looks="a different gain at large loads, in both directions alike; odd harmonics",
    source="pressure-compensated and load-sensing valves; a valve body that widens",
)

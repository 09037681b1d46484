"""The valve's output changes at a limited rate."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

VALVE_RATE_LIMIT = Effect(
    name="valve_rate_limit",
    place="valve",
    meaning="the valve's output changes at a limited rate",
    does="a limited rate of what the drive sets",
    strength=Parameter(
        "inverse_rate", "a", "s/m", 0.0, 1.0, 0.0, "inverse of the fastest change of the valve's output"
    ),
    texts=("dq = dq / sqrt(1 + (a * dq)**2)",),
    units={"dq": "m/s"},
    looks="phase lag and loss of magnitude that grow with amplitude times frequency times gain",
    source="smooth rate limit",
)

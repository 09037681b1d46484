"""The valve's output changes at a limited rate."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

VALVE_RATE_LIMIT = Effect(
    name="valve_rate_limit",
    place="valve",
    meaning="the rate of the valve output is limited",
    does="a limited rate of the drive",
    strength=Parameter("inverse_rate", "a", "s/m", 0.0, 1.0, 0.0, "inverse of the largest rate of the valve output"),
    texts=("dq = dq / sqrt(1 + (a * dq)**2)",),
    units={"dq": "m/s"},
    looks="more phase lag and less magnitude as amplitude, frequency or gain grow",
    source="smooth rate limit",
)

"""A second lag stands in series with that of the valve."""

from ident.effects.effect import Effect
from ident.parameter import Parameter, Starts

SECOND_LAG = Effect(
    name="second_lag",
    place="valve",
    meaning="a second lag in series with that of the amplifier; both together are a second-order system",
    strength=Parameter("time_constant", "T2", "s", 0.0, 0.1, 0.0, "time constant of the second lag", start=Starts.TIME),
    texts=("q = lag(q, T2)",),
    units={"q": "1"},
    looks="more phase lag than one lag explains, and a rounded start of every movement",
    source="a servo-valve's own lag behind that of amplifier and electronics (Kononykhin, section 4, block a)",
)

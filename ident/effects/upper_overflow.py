"""The upper of two tanks runs over an edge."""

from ident.effects.effect import Effect
from ident.effects.needs import one_sided_position
from ident.parameter import Parameter, Starts

UPPER_OVERFLOW = Effect(
    name="upper_overflow",
    place="flow",
    meaning="the upper tank overflows an edge at the level 1/g, partly into the lower tank",
    strength=Parameter("inverse_level", "g", "1/m", 0.0, 1e3, 0.0, "inverse of the level of the edge", of_motion=True),
    texts=(
        "ho = ho + ro * hb * max(g * hu - 1, 0)",
        "hi = hi + si * ro * hb * max(g * hu - 1, 0)",
    ),
    units={"ho": "m", "hi": "m"},
    shape=(
        Parameter(
            "ratio",
            "ro",
            "1",
            1.0,
            30.0,
            10.0,
            "growth of the outflow by a level above the edge, both of the whole",
            start=Starts.AS_KNOWN,
        ),
        Parameter("caught", "si", "1", 0.0, 1.0, 0.5, "share of the overflow that the lower tank receives"),
    ),
    looks="a larger command of the same duration does not raise the level further",
    source="weir, made linear in the small height above its edge; Schoukens and Noël 2017",
    steps=2,
    needs=one_sided_position,
)

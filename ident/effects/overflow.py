"""What is stored runs over an edge."""

from ident.effects.effect import Effect
from ident.effects.needs import one_sided_position
from ident.parameter import Parameter, Starts

OVERFLOW = Effect(
    name="overflow",
    place="load",
    meaning="the liquid overflows an edge at the level 1/g, so the level hardly rises above it",
    strength=Parameter(
        "inverse_level",
        "g",
        "1/m",
        0.0,
        1e3,
        0.0,
        "inverse of the level of the edge",
        start=Starts.STROKE_END,
        of_motion=True,
    ),
    texts=("xo = xo * (1 + ro * max(g * x - 1, 0))",),
    units={"xo": "m"},
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
    ),
    looks="flat tops at one level, whatever the size of the command",
    source="weir, made linear in the small height above its edge",
    steps=2,
    needs=one_sided_position,
)

"""A constant force acts on the rod."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

STATIC_LOAD = Effect(
    name="static_load",
    place="load",
    meaning="a constant force acts on the rod",
    strength=Parameter("force", "F0", "N", -500.0, 500.0, 0.0, "constant force on the rod"),
    texts=("R = R - F0",),
    units={"R": "N"},
    looks="an offset of each run in proportion to 1/Kp, by the leakage; nothing else in a linear chain",
    source="weight, preload",
)

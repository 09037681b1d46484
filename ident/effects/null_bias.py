"""The spool is open at zero drive signal."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

NULL_BIAS = Effect(
    name="null_bias",
    place="spool",
    meaning="the spool is open at zero drive signal",
    strength=Parameter("bias", "b", "m", -2e-3, 2e-3, 0.0, "opening at zero drive signal"),
    texts=("w = w + b",),
    units={"w": "m"},
    looks="an offset of each run in proportion to 1/Kp; nothing else in a linear chain",
    source="Merritt, Hydraulic Control Systems, null shift",
)

"""The spool stands still until the drive signal is far enough from it."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

SPOOL_STICTION = Effect(
    name="spool_stiction",
    place="valve",
    meaning="the spool sticks until the drive signal differs enough from its position",
    does="the spool moves only above a breakaway signal",
    strength=Parameter("threshold", "s", "m", 0.0, 5e-4, 0.0, "drive difference below which the spool sticks"),
    texts=("dq = where(abs(e - q1) < s, 0, dq)",),
    units={"dq": "m/s"},
    looks="steps and small limit cycles at small amplitudes; small effect at large ones",
    source="stiction of the spool; dither is its remedy",
    steps=4,
    stride=1e-2,
)

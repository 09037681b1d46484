"""The valve's lands overlap: no flow near the centre."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

DEAD_ZONE = Effect(
    name="dead_zone",
    place="spool",
    meaning="the valve lands overlap: no flow near the centre of the valve",
    strength=Parameter("half_width", "h", "m", 0.0, 1e-3, 0.0, "half of the overlap, in the unit of the drive signal"),
    texts=("w = w - clip(w, -h * (1 - a), h * (1 + a))",),
    units={"w": "m"},
    shape=(Parameter("skew", "a", "1", -1.0, 1.0, 0.0, "asymmetry of the dead zone (0: symmetric)"),),
    looks="less magnitude and bandwidth at small amplitudes and low gain; flat spots where the speed changes sign",
    source="Strano and Terzo, asymmetric dead zone; Merritt, Hydraulic Control Systems",
)

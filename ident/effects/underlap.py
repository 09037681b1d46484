"""The valve's lands leave a gap: double flow gain near the centre."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

UNDERLAP = Effect(
    name="underlap",
    place="spool",
    meaning="the valve lands are shorter than the ports: double flow gain near the centre of the valve",
    does="more gain near the centre",
    strength=Parameter("half_width", "h", "m", 0.0, 1e-3, 0.0, "half of the underlap, in the unit of the drive signal"),
    texts=("w = w + clip(w, -h, h)",),
    units={"w": "m"},
    looks="more bandwidth at small amplitudes",
    source="Merritt, Hydraulic Control Systems, open-centre valve",
)

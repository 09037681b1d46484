"""Play of half-width b between valve and spool."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

BACKLASH = Effect(
    name="backlash",
    place="spool",
    meaning="play of half-width b between valve and spool",
    strength=Parameter("half_width", "b", "m", 0.0, 1e-3, 0.0, "half of the play, in the unit of the drive signal"),
    texts=(
        "p := clip(p, w - b, w + b)",
        "w = p",
    ),
    units={"w": "m"},
    looks="more phase lag and less magnitude at small amplitudes, the same at every frequency; flat tops",
    source="Kononykhin, block b; play operator",
    steps=2,
)

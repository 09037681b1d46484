"""A spring holds a mass at its place of rest until the preload is overcome."""

from ident.effects.effect import Effect
from ident.effects.needs import position_driven
from ident.parameter import Parameter

SPRING_PRELOAD = Effect(
    name="spring_preload",
    place="load",
    meaning="a spring holds the mass at its place of rest until its preload is overcome",
    does="a preload at the place of rest",
    strength=Parameter("force", "Fp", "N", 0.0, 1e4, 0.0, "preload of the spring"),
    texts=("R = R + Fp * clip(x / hp, -1, 1)",),
    units={"R": "N"},
    shape=(
        Parameter(
            "width", "hp", "m", 1e-6, 1.0, 1e-3, "way over which the preload reverses, to one side", relative=0.02
        ),
    ),
    looks="no answer to small commands about the place of rest, and a jump of the command where the motion passes it",
    source="a throttle with a limp-home position, Deur et al., IEEE Trans. Control Systems Technology 12 (2004); a "
    "centring spring, Merritt, Hydraulic Control Systems",
    needs=position_driven,
)

"""What is stored runs out with the square root of its level."""

from ident.effects.effect import Effect
from ident.effects.needs import one_sided_position
from ident.parameter import Parameter

ROOT_OUTFLOW = Effect(
    name="root_outflow",
    place="load",
    meaning="the outflow is in proportion to the square root of the level (Torricelli)",
    strength=Parameter("share", "s", "1", 0.0, 1.0, 0.0, "share of the outflow that follows the root"),
    texts=("xo = xo + s * (sgn(x) * sqrt(xr * abs(x)) - x)",),
    units={"xo": "m"},
    shape=(
        Parameter(
            "level", "xr", "m", 1e-3, 1e2, 1.0, "level at which the square root and the linear law agree", relative=1.0
        ),
    ),
    looks="a time constant and a gain that grow with the level",
    source="Torricelli 1643, outflow a sqrt(2 g x); Schoukens and Noël 2017",
    needs=one_sided_position,
    unless="tau1",
)

"""Damping that grows with the square of the speed."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

QUADRATIC_DAMPING = Effect(
    name="quadratic_damping",
    place="load",
    meaning="damping that grows with the square of the speed",
    strength=Parameter("coefficient", "c2", "N*s^2/m^2", 0.0, 2e4, 0.0, "damping force for each squared speed"),
    texts=("R = R + c2 * v * abs(v)",),
    units={"R": "N"},
    looks="less magnitude at mid frequencies as the amplitude grows",
    source="turbulent damping",
)

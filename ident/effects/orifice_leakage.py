"""Leakage through an orifice, as the root of the pressure."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

ORIFICE_LEAKAGE = Effect(
    name="orifice_leakage",
    place="pressure",
    meaning="leakage through an orifice, in proportion to the square root of the pressure",
    does="leakage that grows with the square root of the load",
    strength=Parameter(
        "coefficient", "C", "m^3/(s*Pa^0.5)", 0.0, 1e-8, 0.0, "leakage at a pressure of 1 Pa, turbulent law"
    ),
    texts=("L = L + C * P / (P**2 + P0**2)**0.25",),
    units={"L": "m^3/s"},
    shape=(Parameter("rounding", "P0", "Pa", 1e3, 1e7, 5e4, "pressure below which the leakage is laminar"),),
    looks="damping of the oil column that is large at small amplitudes and falls with amplitude",
    source="Merritt, Hydraulic Control Systems, orifice flow",
)

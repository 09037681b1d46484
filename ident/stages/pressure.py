"""Pressure: from flow and piston speed to the load pressure."""

from ident.parameter import Parameter
from ident.stages.scale import ORDER_OF_MAGNITUDE, Scale
from ident.stages.stage import Quantity, stage

COMPRESSIBLE = stage(
    "pressure",
    (
        Quantity("P", "Pa", "load pressure"),
        Quantity("L", "m^3/s", "leakage across the piston"),
        Quantity("Ke", "m^3/Pa", "effective compressibility of the oil"),
        Quantity("D", "N", "force that drives the load"),
    ),
    ("L = Cl * P", "laminar leakage"),
    ("Ke = Ka", "constant compressibility of the oil"),
    ("P' = (Q - L - A * v) / Ke", "the flow compresses, leaks and moves the piston (Qian et al. 2014, eq. 4)"),
    ("D = A * P", "the load pressure acts on the piston's area"),
    parameters=(
        Parameter("Ka", "Kₐ", "m^3/Pa", 1e-18, 1e6, 1.0, "compressibility of the oil, Vt/(4 βe)", ORDER_OF_MAGNITUDE),
        Parameter("Cl", "Cₗ", "m^3/(s*Pa)", 1e-18, 1e6, 1e-3, "leakage across the piston", ORDER_OF_MAGNITUDE),
    ),
    scales=(Scale("Ka", "A**2 / (m0 * W**2)", 1e-4, 1e2), Scale("Cl", "Ka * W", 1e-5, 1e1)),
)

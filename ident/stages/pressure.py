"""Pressure: from flow and piston speed to the load pressure, or from a known pressure to the force."""

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

ACTING_PRESSURE = stage(
    "pressure",
    (Quantity("D", "N", "force, or torque, that drives the load"),),
    ("D = Ap * w", "the known pressure acts on an area (Merritt 1967, section 6-2)"),
    parameters=(
        Parameter(
            "Ap",
            "Aₚ",
            "N/m",
            1e-12,
            1e12,
            1.0,
            "area on which the pressure acts, or torque for each unit of it",
            ORDER_OF_MAGNITUDE,
        ),
    ),
    scales=(Scale("Ap", "mL * L * W**2 / U", 1e-3, 1e5),),
)
"""A pressure that nothing of the motion changes: of a regulator, or as measured."""

"""Pressure: from flow and piston speed to the load pressure."""

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
    ("Ke = Ka", "the oil compresses alike everywhere"),
    ("P' = (Q - L - A * v) / Ke", "the flow compresses, leaks and moves the piston (Qian et al. 2014, eq. 4)"),
    ("D = A * P", "the load pressure acts on the piston's area"),
)

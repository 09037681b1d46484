"""Pressure: from flow and piston speed to the load pressure."""

from ident.stages.stage import Quantity, stage

COMPRESSIBLE = stage(
    "pressure",
    (Quantity("P", "Pa", "load pressure"),),
    ("P' = (Q - Cl * P - A * v) / Ka", "the flow compresses, leaks and moves the piston (Qian et al. 2014, eq. 4)"),
)

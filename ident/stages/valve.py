"""Valve: from the drive signal to the flow of the pilot stage."""

from ident.stages.stage import Quantity, stage

FIRST_ORDER_VALVE = stage(
    "valve",
    (Quantity("q", "m", "valve output, in the unit of the drive signal"),),
    ("q' = (e - q) / tau", "first-order lag of the pilot stage, gain moved into Z0 (Qian et al. 2014, eq. 1)"),
)

"""Spool: from the valve's output to the opening of the main stage."""

from ident.stages.stage import Quantity, stage

RIGID_SPOOL = stage(
    "spool",
    (Quantity("w", "m", "spool opening, in the unit of the drive signal"),),
    ("w = q", "spool opening proportional to the pilot flow (Qian et al. 2014, eq. 3)"),
)

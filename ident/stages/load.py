"""Load: from the load pressure to the motion of rod and specimen."""

from ident.stages.stage import Quantity, stage

MASS_SPRING_DAMPER = stage(
    "load",
    (Quantity("v", "m/s", "piston speed"), Quantity("x", "m", "piston position")),
    ("v' = (A * P - (c0 + cL) * v - k * x) / (m0 + mL)", "rod and specimen move together (Qian et al. 2014, eq. 6)"),
    ("x' = v", "position is the integral of speed"),
)

"""Valve: from the drive signal to the flow of the pilot stage."""

from ident.parameter import Parameter
from ident.stages.scale import ORDER_OF_MAGNITUDE, Scale
from ident.stages.stage import Quantity, stage

FIRST_ORDER_VALVE = stage(
    "valve",
    (
        Quantity("q1", "m", "output of the pilot stage, in the unit of the drive signal"),
        Quantity("dq", "m/s", "its rate"),
        Quantity("q", "m", "valve output, in the unit of the drive signal"),
    ),
    ("dq = (e - q1) / tau", "first-order lag of the pilot stage, gain moved into Z0 (Qian et al. 2014, eq. 1)"),
    ("q1' = dq", "the pilot stage integrates its rate"),
    ("q = q1", "nothing behind the lag"),
    parameters=(Parameter("tau", "τ", "s", 1e-5, 1e2, 1e-2, "time constant of the valve", ORDER_OF_MAGNITUDE),),
    scales=(Scale("tau", "1 / W", 1e-3, 3e1),),
)

"""Valve: from the drive signal to the flow of the pilot stage."""

from ident.parameter import Parameter, Starts
from ident.stages.scale import ORDER_OF_MAGNITUDE, Scale
from ident.stages.stage import Quantity, stage

FIRST_ORDER_VALVE = stage(
    "valve",
    (
        Quantity("q1", "m", "output of the pilot stage, in the unit of the drive signal"),
        Quantity("dq", "m/s", "rate of the command"),
        Quantity("q", "m", "valve output, in the unit of the drive signal"),
    ),
    ("dq = (e - q1) / tau", "first-order lag of the pilot stage, gain moved into Z0 (Qian et al. 2014, eq. 1)"),
    ("q1' = dq", "the pilot stage integrates its rate"),
    ("q = q1", "no additional valve dynamics"),
    parameters=(
        Parameter(
            "tau", "τ", "s", 1e-5, 1e2, 1e-2, "time constant of the valve", ORDER_OF_MAGNITUDE, start=Starts.TIME
        ),
    ),
    scales=(Scale("tau", "1 / W", 1e-3, 3e1),),
)

SECOND_ORDER_VALVE = stage(
    "valve",
    (
        Quantity("q1", "m", "output of the pilot stage, in the unit of the drive signal"),
        Quantity("dq", "m/s", "rate of the command"),
        Quantity("q", "m", "valve output, in the unit of the drive signal"),
    ),
    ("q1' = dq", "the pilot stage integrates its rate"),
    ("dq' = wv**2 * (e - q1) - 2 * zv * wv * dq", "second-order valve (Merritt 1967, section 7-4)"),
    ("q = q1", "no additional valve dynamics"),
    parameters=(
        Parameter("wv", "ω_v", "1/s", 1e-1, 1e5, 1e3, "natural frequency of the valve", ORDER_OF_MAGNITUDE),
        Parameter("zv", "ζ_v", "1", 5e-2, 5e0, 0.7, "damping ratio of the valve", ORDER_OF_MAGNITUDE),
    ),
    scales=(Scale("wv", "W", 1e-1, 1e2), Scale("zv", "1", 5e-2, 5e0)),
)

INSTANT_VALVE = stage(
    "valve",
    (Quantity("q", "m", "output of valve or amplifier, in the unit of the drive signal"),),
    ("q = e", "the valve follows without delay"),
)

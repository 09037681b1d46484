"""Drives whose force acts on the load directly: open loop, or under a position loop with a speed loop inside."""

from ident.parameter import Parameter
from ident.stages.scale import ORDER_OF_MAGNITUDE, Scale
from ident.stages.stage import Quantity, stage

FORCE_AS_RECORDED = stage(
    "controller",
    (Quantity("r", "N", "force as it acts"),),
    ("r = u", "the recorded force acts without delay"),
)
"""Nothing is controlled; a delay between the force that is asked for, or its record, and the load acts here."""

DIRECT_FORCE = stage("pressure", (Quantity("D", "N", "force that drives the load"),), ("D = r", "the recorded force"))

BASE_AS_RECORDED = stage(
    "controller",
    (Quantity("r", "m/s^2", "acceleration of the base as it acts"), Quantity("D", "N", "force that drives the load")),
    ("r = u", "the recorders of base and mass have one clock"),
    ("D = 0", "no drive is there"),
)
"""Nothing is controlled, and nothing drives; a delay between the records of the base and of the mass acts here."""

CASCADE = stage(
    "controller",
    (
        Quantity("r", "m", "command as it acts"),
        Quantity("dr", "m/s", "rate of the command"),
        Quantity("y_in", "m", "position that the controller uses"),
        Quantity("v_in", "m/s", "rate of that position"),
        Quantity("e", "N", "force commanded by the controller"),
    ),
    ("r = u", "the command acts without delay"),
    ("dr = du", "rate of the command"),
    ("y_in = y_fb", "the controller reads the transducer without delay"),
    ("v_in = v_fb", "rate of the same reading"),
    ("e = kv * (kp * (r - y_in) - v_in)", "position loop kp around a speed loop kv"),
    parameters=(
        Parameter("kp", "kₚ", "1/s", 1e-2, 1e4, 100.0, "gain of the position loop", ORDER_OF_MAGNITUDE),
        Parameter(
            "kv", "kᵥ", "N*s/m", 1e-2, 1e8, 1e3, "gain of the speed loop, from speed to force", ORDER_OF_MAGNITUDE
        ),
    ),
    scales=(Scale("kp", "W", 1e-2, 1e3), Scale("kv", "m0 * W", 1e-2, 1e4)),
)

IDEAL_DRIVE = stage(
    "pressure", (Quantity("D", "N", "force that drives the load"),), ("D = e", "the motor gives the force at once")
)

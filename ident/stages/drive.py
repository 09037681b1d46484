"""Drives whose force acts on the load directly: open loop, or under a position loop with a speed loop inside."""

from ident.stages.stage import Quantity, stage

DIRECT_FORCE = stage("pressure", (Quantity("D", "N", "force that drives the load"),), ("D = u", "the recorded force"))

CASCADE = stage(
    "controller",
    (
        Quantity("r", "m", "command as it acts"),
        Quantity("dr", "m/s", "rate of the command"),
        Quantity("y_in", "m", "position that the controller uses"),
        Quantity("v_in", "m/s", "rate of that position"),
        Quantity("e", "N", "force that the controller asks for"),
    ),
    ("r = u", "the command acts at once"),
    ("dr = du", "its rate"),
    ("y_in = y_fb", "the controller uses the transducer's reading at once"),
    ("v_in = v_fb", "and so its rate"),
    ("e = kv * (kp * (r - y_in) - v_in)", "position loop kp around a speed loop kv"),
)

IDEAL_DRIVE = stage(
    "pressure", (Quantity("D", "N", "force that drives the load"),), ("D = e", "the motor gives the force at once")
)

"""Controller: from command and fed-back position to the valve's drive signal."""

from ident.stages.stage import Quantity, stage

PROPORTIONAL = stage(
    "controller",
    (
        Quantity("r", "m", "command as it acts"),
        Quantity("dr", "m/s", "rate of the command"),
        Quantity("y_in", "m", "position that the controller uses"),
        Quantity("v_in", "m/s", "rate of that position"),
        Quantity("e", "m", "drive signal, in metres times the dial of the gain"),
    ),
    ("r = u", "the command acts at once"),
    ("dr = du", "its rate"),
    ("y_in = y_fb", "the controller uses the transducer's reading at once"),
    ("v_in = v_fb", "and so its rate"),
    ("e = Kp * (r - y_in)", "proportional position loop with gain Kp (Qian et al. 2014, section 2.1.1)"),
)

OPENED_BY_COMMAND = stage(
    "controller",
    (
        Quantity("r", "m", "command as it acts"),
        Quantity("dr", "m/s", "rate of the command"),
        Quantity("e", "m", "drive signal: the opening that is asked for"),
    ),
    ("r = u", "the command acts at once"),
    ("dr = du", "its rate"),
    ("e = r", "no loop: the command opens the valve"),
)

"""Controller: from command and fed-back position to the valve's drive signal."""

from ident.stages.stage import Quantity, stage

PROPORTIONAL = stage(
    "controller",
    (Quantity("e", "m", "drive signal, in metres times the dial of the gain"),),
    ("e = Kp * (u - y_fb)", "proportional position loop with gain Kp (Qian et al. 2014, section 2.1.1)"),
)

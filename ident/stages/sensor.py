"""Sensor: from the piston's position to what the controller and the recorder see."""

from ident.stages.stage import Quantity, stage

IDEAL_SENSOR = stage(
    "sensor",
    (
        Quantity("y_fb", "m", "reading of the transducer, which the controller sees"),
        Quantity("v_fb", "m/s", "rate of the reading"),
        Quantity("y", "m", "position that is recorded"),
    ),
    ("y_fb = X", "ideal displacement transducer in the loop"),
    ("v_fb = v", "it follows the rod at once"),
    ("y = y_fb", "the recorder sees what the transducer reads"),
)

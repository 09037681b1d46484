"""Sensor: from the piston's position to what the controller and the recorder see."""

from ident.stages.stage import Quantity, stage

IDEAL_SENSOR = stage(
    "sensor",
    (Quantity("y_fb", "m", "position that the controller sees"), Quantity("y", "m", "position that is recorded")),
    ("y_fb = x", "ideal displacement transducer in the loop"),
    ("y = y_fb", "the recorder sees what the controller sees"),
)

"""Sensor: from the piston's position to what the controller and the recorder see."""

from ident.stages.stage import Quantity, Stage, stage

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


def transducer(shown: str, rate: str) -> Stage:
    """A transducer in the loop that reads another signal than the position, and its rate."""
    return IDEAL_SENSOR.with_equations(
        (f"y_fb = {shown}", "ideal transducer in the loop"), (f"v_fb = {rate}", "the rate of its reading")
    )

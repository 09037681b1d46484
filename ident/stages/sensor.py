"""Sensor: from the piston's position to what the controller and the recorder see."""

from dataclasses import replace

from ident.parameter import Parameter
from ident.stages.scale import Scale
from ident.stages.stage import Quantity, Stage, stage

IDEAL_SENSOR = stage(
    "sensor",
    (
        Quantity("y_fb", "m", "reading of the transducer, input of the controller"),
        Quantity("v_fb", "m/s", "rate of the reading"),
        Quantity("y", "m", "position that is recorded"),
        Quantity("vy", "m/s", "speed that is recorded"),
    ),
    ("y_fb = X", "ideal displacement transducer in the loop"),
    ("v_fb = v", "it follows the rod at once"),
    ("y = y_fb", "the record shows the reading of the transducer"),
    ("vy = v", "a transducer of the speed reads it as it is"),
)


def transducer(shown: str, rate: str, unit: str) -> Stage:
    """A transducer in the loop that reads another signal than the position, and its rate; `unit`: of m for one."""
    calibration = Parameter("cal", "cal", unit, 1e-3, 1e3, 1.0, "reading of the transducer, 1 by convention")
    read = (f"y_fb = cal * {shown}", "ideal transducer in the loop")
    return replace(
        IDEAL_SENSOR.with_equations(read, (f"v_fb = cal * {rate}", "the rate of its reading")),
        parameters=(calibration,),
        scales=(Scale.by_bounds(calibration),),
    )

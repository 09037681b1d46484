"""The transducer's reading is bent, inside the loop."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

SENSOR_NONLINEARITY = Effect(
    name="sensor_nonlinearity",
    place="sensor",
    meaning="the transducer is nonlinear, inside the loop",
    strength=Parameter("curvature", "s", "1/m^2", -1e5, 1e5, 0.0, "relative error for each square metre of reading"),
    texts=(
        "v_fb = v_fb * (1 + 3 * s * y_fb**2)",
        "y_fb = y_fb * (1 + s * y_fb**2)",
    ),
    units={"y_fb": "m", "v_fb": "m/s"},
    looks="a loop gain that changes with the displacement; in open loop a distorted record; odd harmonics",
    source="linearity error of an LVDT beyond its range; loop and recorder see one transducer",
)

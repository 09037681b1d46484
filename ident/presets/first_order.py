"""The first-order closed-loop model k / (τ s + 1) of the hybrid-simulation paper: what a tracking filter follows."""

from ident.chain.chain import Chain
from ident.parameter import Parameter, Starts
from ident.presets.preset import Preset, SearchPlan
from ident.stages import IDEAL_SENSOR, INSTANT_VALVE, OPENED_BY_COMMAND, RIGID_SPOOL, Quantity, Scale
from ident.stages.stage import stage

TRACKING_LAG = stage(
    "load",
    (
        Quantity("x", "m", "position"),
        Quantity("xi", "m", "what drives the output"),
        Quantity("xo", "m", "what draws the output back"),
        Quantity("v", "m/s", "speed"),
        Quantity("X", "m", "position of what the transducer is fixed to"),
    ),
    ("xi = gain * w", "in proportion to the command"),
    ("xo = x", "the output draws itself back"),
    ("v = (xi - xo) / tau", "the closed loop follows its command like a single lag"),
    ("x' = v", "position is the integral of speed"),
    ("X = x", "the transducer's frame is rigid"),
    parameters=(
        Parameter("gain", "kyr", "1", 1e-2, 1e2, 1.0, "static gain from command to output"),
        Parameter("tau", "τyr", "s", 1e-4, 1e1, 1e-2, "time constant of the closed loop", start=Starts.TIME),
    ),
    scales=(Scale("gain", "X / U", -3e1, 3e1, logarithmic=False), Scale("tau", "1 / W", 1e-3, 1e3)),
)

FIRST_ORDER = Preset(
    name="first_order",
    title="First-order tracking",
    citation=(
        "S. Strano, M. Terzo et al.: servo-hydraulic hybrid simulation with an extended Kalman filter; "
        "closed-loop model τyr y' + y = kyr r."
    ),
    chain=Chain(
        stages=(OPENED_BY_COMMAND, INSTANT_VALVE, RIGID_SPOOL, TRACKING_LAG, IDEAL_SENSOR),
        outputs=dict.fromkeys(
            ("displacement", "velocity", "acceleration", "load_pressure", "force", "temperature", "current"), "y"
        ),
    ),
    static_gains=("gain",),
    search=SearchPlan(
        drive_scale="U",
        methods=("ekf",),
    ),
)

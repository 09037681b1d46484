"""A drive: force → mass, spring and damper, open loop or under a position loop."""

from ident.chain.chain import Chain
from ident.parameter import Parameter
from ident.presets.preset import Combined, Preset, Scale
from ident.stages import CASCADE, DIRECT_FORCE, DRIVEN_MASS, IDEAL_DRIVE, IDEAL_SENSOR

SOURCE = "order of magnitude; searched over scale-free ratios"
MOVED = (
    Parameter("m0", "m₀", "kg", 1e-2, 1e4, 1.0, "moving mass", SOURCE),
    Parameter("c0", "c₀", "N*s/m", 1e-2, 1e6, 1.0, "viscous friction", SOURCE),
    Parameter("k0", "k₀", "N/m", 1e-6, 1e9, 1.0, "stiffness of the spring to the ground", SOURCE),
)
OUTPUTS = {"displacement": "y", "force": "F"}
FORCE_SCALE = "(c0 + m0*W)*W*X"
CITATION = (
    "A. Janot, M. Gautier, M. Brunot: data set and reference models of EMPS. "
    "Workshop on Nonlinear System Identification Benchmarks (2019)."
)

UNDER_CONTROL = Preset(
    name="drive",
    title="Drive under a position loop",
    citation=CITATION,
    chain=Chain(stages=(CASCADE, IDEAL_DRIVE, DRIVEN_MASS, IDEAL_SENSOR), outputs=OUTPUTS),
    parameters=(
        *MOVED,
        Parameter("kp", "kₚ", "1/s", 1e-2, 1e4, 100.0, "gain of the position loop", SOURCE),
        Parameter("kv", "kᵥ", "N*s/m", 1e-2, 1e8, 1e3, "gain of the speed loop, from speed to force", SOURCE),
    ),
    scales=(
        Scale("m0", "mL", 1e-2, 1e3),
        Scale("kp", "W", 1e-2, 1e3),
        Scale("kv", "m0 * W", 1e-2, 1e4),
        Scale("c0", "m0 * W", 1e-4, 1e3),
        Scale("k0", "m0 * W**2", 1e-6, 1e2),
    ),
    force_scale=FORCE_SCALE,
    share_force=("m0", "c0", "k0", "kv"),
    combinations=(
        Combined("kp*kv / m0", "1/s^2", "stiffness of the position loop over the mass"),
        Combined("(kv + c0) / m0", "1/s", "damping of the loop over the mass"),
        Combined("c0 / m0", "1/s", "friction over the mass"),
    ),
)

DRIVE = Preset(
    name="drive",
    title="Drive",
    citation=CITATION,
    chain=Chain(stages=(DIRECT_FORCE, DRIVEN_MASS, IDEAL_SENSOR), outputs=OUTPUTS),
    parameters=MOVED,
    scales=(
        Scale("m0", "U / (X * W**2)", 1e-3, 1e7),
        Scale("c0", "U / (X * W)", 1e-4, 1e5),
        Scale("k0", "U / X", 1e-6, 1e2),
    ),
    driven_by="drive_force",
    force_scale=FORCE_SCALE,
    methods=("inverse-dynamics",),
    under_control=UNDER_CONTROL,
)

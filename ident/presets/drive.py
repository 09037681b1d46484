"""A drive: force → mass, spring and damper, open loop or under a position loop."""

from ident.chain.chain import Chain
from ident.presets.preset import Combined, Preset, RequiredData, SearchPlan
from ident.stages import CASCADE, DIRECT_FORCE, DRIVEN_MASS, FORCE_AS_RECORDED, IDEAL_DRIVE, IDEAL_SENSOR, Scale

OUTPUTS = {"displacement": "y", "force": "F"}
OPEN_OUTPUTS = {**OUTPUTS, "velocity": "vy", "acceleration": "ay"}
"""Of the mass alone; no loop of a position is closed over a speed."""
FORCE_SCALE = "(c0 + m0*W)*W*L"
CITATION = (
    "A. Janot, M. Gautier, M. Brunot: data set and reference models of EMPS. "
    "Workshop on Nonlinear System Identification Benchmarks (2019)."
)

UNDER_CONTROL = Preset(
    name="drive",
    title="Drive under a position loop",
    citation=CITATION,
    chain=Chain(stages=(CASCADE, IDEAL_DRIVE, DRIVEN_MASS, IDEAL_SENSOR), outputs=OUTPUTS),
    listed=("m0", "c0", "k0"),
    combinations=(
        Combined("kp*kv / m0", "1/s^2", "stiffness of the position loop over the mass"),
        Combined("(kv + c0) / m0", "1/s", "damping of the loop over the mass"),
        Combined("c0 / m0", "1/s", "friction over the mass"),
    ),
    search=SearchPlan(
        order=("m0", "kp", "kv"),
        force_scale=FORCE_SCALE,
    ),
    data=RequiredData(
        share_force=("m0", "c0", "k0", "kv"),
    ),
)

DRIVE = Preset(
    name="drive",
    title="Drive",
    citation=CITATION,
    chain=Chain(stages=(FORCE_AS_RECORDED, DIRECT_FORCE, DRIVEN_MASS, IDEAL_SENSOR), outputs=OPEN_OUTPUTS),
    search=SearchPlan(
        rescaled=(
            Scale("m0", "U / (L * W**2)", 1e-3, 1e7),
            Scale("c0", "U / (L * W)", 1e-4, 1e5),
            Scale("k0", "U / L", 1e-6, 1e2),
        ),
        force_scale="M",  # the largest drive force: what holds more stands still
        methods=("inverse-dynamics",),
    ),
    data=RequiredData(
        driven_by="drive_force",
    ),
    under_control=UNDER_CONTROL,
)

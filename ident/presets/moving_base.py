"""A mass with spring and damper on a base that is moved: acceleration of the base → motion of the mass."""

from ident.chain.chain import Chain
from ident.presets.preset import Combined, Preset, RequiredData, SearchPlan
from ident.stages import BASE_AS_RECORDED, IDEAL_SENSOR, MASS_ON_BASE

MOVING_BASE = Preset(
    name="moving_base",
    title="Mass on a moving base",
    citation=(
        "A. K. Chopra: Dynamics of Structures. Pearson, sections 1.7 and 6.1: m r'' + c r' + k r = −m a_B, with r the "
        "motion against the base; an accelerometer on the mass shows r'' + a_B."
    ),
    chain=Chain(
        stages=(BASE_AS_RECORDED, MASS_ON_BASE, IDEAL_SENSOR),
        outputs={"acceleration": "ay", "displacement": "y", "velocity": "vy"},
    ),
    listed=("m0", "c0", "k0"),
    combinations=(
        Combined("k0 / m0", "1/s^2", "ω0², the spring against the mass"),
        Combined("c0 / m0", "1/s", "damping of the mass"),
    ),
    search=SearchPlan(
        force_scale="m0*M",  # the largest force of inertia: what holds more stands still
    ),
    data=RequiredData(
        command_units=("m/s^2",),
        share_force=("m0", "c0", "k0"),
    ),
)

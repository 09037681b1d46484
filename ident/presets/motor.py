"""A motor in open loop: command → speed, or position."""

from ident.chain.chain import Chain
from ident.presets.preset import Combined, Display, Preset, RequiredData, SearchPlan
from ident.stages import IDEAL_SENSOR, INSTANT_VALVE, MASS_SPRING_DAMPER, OPENED_BY_COMMAND, RIGID_SPOOL, TORQUE, Scale

MOTOR = Preset(
    name="motor",
    title="Motor in open loop",
    citation="A DC motor whose inductance is small: J ω' + c ω = K u, with c of friction and induced voltage together.",
    chain=Chain(
        stages=(OPENED_BY_COMMAND, INSTANT_VALVE, RIGID_SPOOL, TORQUE, MASS_SPRING_DAMPER, IDEAL_SENSOR),
        outputs={"velocity": "vy", "displacement": "y", "acceleration": "ay"},
    ),
    combinations=(
        Combined("Kt / c0", "1/s", "speed for each unit of the command"),
        Combined("m0 / c0", "s", "time constant"),
        Combined("Kt / m0", "1/s^2", "acceleration for each unit of the command"),
    ),
    search=SearchPlan(
        rescaled=(Scale("m0", "1", 1e-2, 1e6), Scale("c0", "m0 * W", 1e-4, 1e2)),
        force_scale="Kt*M",  # the largest torque: what holds more stands still
        drive_scale="U",
    ),
    data=RequiredData(
        share_force=("m0", "c0", "Kt"),
        turns=True,
    ),
    display=Display(
        of_drive=("Kt",),
    ),
)

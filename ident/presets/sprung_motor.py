"""A motor that works against a spring: command → motion of a mass that swings about a position."""

from ident.chain.chain import Chain
from ident.presets.preset import Combined, Display, Preset, RequiredData, SearchPlan
from ident.stages import DRIVEN_MASS, IDEAL_SENSOR, INSTANT_VALVE, OPENED_BY_COMMAND, RIGID_SPOOL, TORQUE, Scale

SPRUNG_MOTOR = Preset(
    name="sprung_motor",
    title="Motor against a spring",
    citation=(
        "G. F. Franklin, J. D. Powell, A. Emami-Naeini: Feedback Control of Dynamic Systems. Pearson, sections 2.1 "
        "(pendulum) and 2.3 (motor, moving coil): m x'' + c x' + k x = K u, with c of friction and induced voltage."
    ),
    chain=Chain(
        stages=(OPENED_BY_COMMAND, INSTANT_VALVE, RIGID_SPOOL, TORQUE, DRIVEN_MASS, IDEAL_SENSOR),
        outputs={"displacement": "y", "velocity": "vy", "acceleration": "ay"},
    ),
    listed=("m0", "c0", "k0", "Kt"),
    combinations=(
        Combined("k0 / m0", "1/s^2", "ω0², the spring against the moving mass"),
        Combined("c0 / m0", "1/s", "damping of the moving mass"),
        Combined("Kt / m0", "1/s^2", "acceleration for each unit of the command"),
        Combined("Kt / k0", "1", "position for each unit of the command"),
    ),
    search=SearchPlan(
        rescaled=(Scale("m0", "1", 1e-2, 1e6), Scale("Kt", "m0 * L * W**2 / U", 1e-4, 1e4)),
        force_scale="Kt*M",  # the largest torque: what holds more stands still
        drive_scale="U",
    ),
    data=RequiredData(
        command_units=("V", "A", "1"),
        rings=True,
        share_force=("m0", "c0", "k0", "Kt"),
    ),
    display=Display(
        of_drive=("Kt",),
    ),
)

"""A cylinder, bellows or muscle whose pressure is known: pressure → position or speed of its load."""

from ident.chain.chain import Chain
from ident.presets.preset import Combined, Display, Preset, RequiredData, SearchPlan
from ident.stages import (
    ACTING_PRESSURE,
    DRIVEN_MASS,
    IDEAL_SENSOR,
    INSTANT_VALVE,
    OPENED_BY_COMMAND,
    RIGID_SPOOL,
    Scale,
)

PRESSURE_DRIVE = Preset(
    name="pressure_drive",
    title="Mass, spring and damper driven by a pressure",
    citation=(
        "H. E. Merritt: Hydraulic Control Systems. Wiley (1967), section 6-2: the force balance of a piston, "
        "m x'' + c x' + k x = A p, of a pressure that a regulator sets or that was measured."
    ),
    chain=Chain(
        stages=(OPENED_BY_COMMAND, INSTANT_VALVE, RIGID_SPOOL, ACTING_PRESSURE, DRIVEN_MASS, IDEAL_SENSOR),
        outputs={"displacement": "y", "velocity": "vy", "acceleration": "ay"},
    ),
    listed=("m0", "c0", "k0", "Ap"),
    without_area={"m0": ("m0/Ap", "kg"), "c0": ("c0/Ap", "N*s/m"), "k0": ("k0/Ap", "N/m")},
    combinations=(
        Combined("k0 / m0", "1/s^2", "ω0², the spring against the moving mass"),
        Combined("c0 / m0", "1/s", "damping of the moving mass"),
        Combined("Ap / m0", "1/s^2", "acceleration for each unit of pressure"),
        Combined("Ap / k0", "1", "motion for each unit of pressure"),
    ),
    search=SearchPlan(
        rescaled=(
            Scale("m0", "Ap * U / (L * W**2)", 1e-3, 1e7),
            Scale("c0", "Ap * U / (L * W)", 1e-4, 1e5),
            Scale("k0", "Ap * U / L", 1e-6, 1e2),
        ),
        force_scale="Ap*M",  # the largest force: what holds more stands still
        drive_scale="U",
    ),
    data=RequiredData(
        command_units=("Pa",),
        area="Ap",
    ),
    display=Display(
        of_drive=("Ap",),
    ),
)

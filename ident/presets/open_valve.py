"""A valve-controlled cylinder in open loop: valve opening → load pressure."""

from ident.chain.chain import Chain
from ident.presets.preset import Combined, Preset, RequiredData, SearchPlan
from ident.stages import (
    COMPRESSIBLE,
    FIRST_ORDER_VALVE,
    IDEAL_SENSOR,
    LINEAR_FLOW,
    MASS_SPRING_DAMPER,
    OPENED_BY_COMMAND,
    RIGID_SPOOL,
    Scale,
)

OPEN_VALVE = Preset(
    name="open_valve",
    title="Valve-controlled cylinder in open loop",
    citation=(
        "H. E. Merritt: Hydraulic Control Systems. Wiley (1967), section 6-2: valve-controlled piston; "
        "the valve's lag as in Qian et al. (2014), eq. 1."
    ),
    chain=Chain(
        stages=(
            OPENED_BY_COMMAND,
            FIRST_ORDER_VALVE,
            RIGID_SPOOL,
            LINEAR_FLOW,
            COMPRESSIBLE,
            MASS_SPRING_DAMPER,
            IDEAL_SENSOR,
        ),
        outputs={"load_pressure": "P", "displacement": "y", "velocity": "vy", "acceleration": "ay", "force": "F"},
    ),
    listed=("m0", "tau", "c0", "Ka", "Cl", "Z0"),
    without_area={
        "Z0": ("Z0/A^3", "1/(m^2*s)"),
        "Ka": ("Ka/A^2", "m/N"),
        "Cl": ("Cl/A^2", "m/(N*s)"),
        "m0": ("m0/A^2", "kg/m^4"),
    },
    combinations=(
        Combined("A**2 / (Ka*m0)", "1/s^2", "ωh², the oil column against the moving mass"),
        Combined("Z0 / (A*Ka)", "Pa/(m*s)", "rate of pressure for each unit of opening"),
        Combined("c0 / m0", "1/s", "damping of the moving mass"),
        Combined("Cl / Ka", "1/s", "decay of a pressure by leakage"),
    ),
    search=SearchPlan(
        rescaled=(
            Scale("m0", "1", 1e-2, 1e6),
            Scale("c0", "m0 * W", 1e-4, 1e2),
            Scale("Ka", "A**2 / (m0 * W**2)", 1e-3, 1e3),
            Scale("Z0", "A**3 * X / (m0 * W * U)", -3e1, 3e1, logarithmic=False),
        ),
        rescaled_by_output={
            # V, where no speed is recorded, is the largest that the band allows.
            "displacement": (Scale("Z0", "A**2 * V / U", -1.0, 1.0, logarithmic=False),),
            # A recorded speed is less than that of a slow command by what the lags of valve and oil take.
            "velocity": (Scale("Z0", "A**2 * V / U", -1e1, 1e1, logarithmic=False),),
        },
        force_scale="(c0 + m0*W)*W*L",
        drive_scale="U",
    ),
    data=RequiredData(
        share_force=("m0", "c0", "Ka", "Cl"),
    ),
)

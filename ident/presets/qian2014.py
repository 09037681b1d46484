"""The linear servo-hydraulic actuator of Qian et al. (2014), section 2.1, Tables 2 and 4."""

from ident.chain.chain import Chain
from ident.parameter import Parameter, Starts
from ident.presets.preset import Combined, Display, Preset, RequiredData, SearchPlan
from ident.stages import (
    COMPRESSIBLE,
    FIRST_ORDER_VALVE,
    IDEAL_SENSOR,
    LINEAR_FLOW,
    MASS_SPRING_DAMPER,
    PROPORTIONAL,
    RIGID_SPOOL,
    Scale,
)

TABLE_2 = "Qian et al. 2014, Tables 2 and 4"

QIAN2014 = Preset(
    name="qian2014",
    title="Linear servo-hydraulic actuator",
    citation=(
        "Y. Qian, G. Ou, A. Maghareh, S. J. Dyke: Parametric identification of a servo-hydraulic actuator for "
        "real-time hybrid simulation. Mechanical Systems and Signal Processing 48 (2014) 260-273."
    ),
    chain=Chain(
        stages=(
            PROPORTIONAL,
            FIRST_ORDER_VALVE,
            RIGID_SPOOL,
            LINEAR_FLOW,
            COMPRESSIBLE,
            MASS_SPRING_DAMPER,
            IDEAL_SENSOR,
        ),
        outputs={"displacement": "y", "load_pressure": "P", "force": "F", "acceleration": "ay"},
    ),
    stated=(
        Parameter("Z0", "Z₀", "m^4/s", 1.751e-6, 3.503e-6, 2.592e-6, "gain of valve, spool and piston", TABLE_2),
        Parameter("tau", "τ", "s", 1e-3, 6e-3, 3.6e-3, "time constant of the servo-valve", TABLE_2, start=Starts.TIME),
        Parameter("Cl", "Cₗ", "m^3/(s*Pa)", 2e-12, 2e-11, 1e-11, "leakage across the piston", TABLE_2),
        Parameter("c0", "c₀", "N*s/m", 800.0, 5000.0, 3200.0, "viscous damping of the actuator", TABLE_2),
        Parameter("m0", "m₀", "kg", 1.0, 10.0, 4.25, "mass of rod, piston and what moves with them", TABLE_2),
        Parameter("Ka", "Kₐ", "m^3/Pa", 2e-15, 2e-13, 1.39e-13, "compressibility of the oil, Vt/(4 βe)", TABLE_2),
    ),
    without_area={"Z0": ("Z0/A^2", "1/s"), "Ka": ("Ka/A^2", "m/N"), "Cl": ("Cl/A^2", "m/(N*s)")},
    combinations=(
        Combined("Z0 / (A**2 + Cl*c0)", "1/s", "speed gain of the loop, for Kp = 1 and no specimen"),
        Combined(
            "(A**2*tau + Ka*c0 + Cl*m0 + tau*Cl*c0) / (A**2 + Cl*c0)", "s", "sum of the lags behind the speed gain"
        ),
        Combined("(Ka*tau*c0 + tau*Cl*m0 + Ka*m0) / (A**2 + Cl*c0)", "s^2", "second-order lag behind the speed gain"),
        Combined("Ka*tau*m0 / (A**2 + Cl*c0)", "s^3", "third-order lag behind the speed gain"),
        Combined("Ka*m0 / A**2", "s^2", "1/ωh², the oil column against the moving mass"),
        Combined("c0 / m0", "1/s", "damping of the moving mass"),
        Combined("Cl*c0 / A**2", "1", "share of the leakage that the damping causes"),
        Combined("Cl / Ka", "1/s", "decay of a pressure by leakage"),
    ),
    notes=(
        "Z0 is printed in m^3/(s*kPa), which is not its unit: p5 = Z0 Kp + Cl k has the unit m^4/s. The printed "
        "number was converted from in^4/s with the factor of in^3/(s*psi); 1.48e-5 as printed is 2.592e-6 m^4/s.",
    ),
    search=SearchPlan(
        rescaled=(Scale("Cl", "A**2 / c0", 1e-5, 1e1),),
        order=("Z0", "tau", "m0", "c0", "Ka", "Cl"),
        bounds_hold_for=4.97e-4,
        force_scale="(c0 + m0*W)*W*L",
    ),
    data=RequiredData(
        share_force=("m0", "c0", "Ka", "Cl"),
    ),
    display=Display(
        shown=("Z0", "c0"),
    ),
)

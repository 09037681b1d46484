"""The specimen yields and dissipates, after Bouc and Wen."""

from ident.effects.effect import Effect
from ident.parameter import AtReversals, Parameter

SPECIMEN_HYSTERESIS = Effect(
    name="specimen_hysteresis",
    place="load",
    meaning="the specimen has hysteresis (Bouc-Wen): it yields and dissipates energy",
    does="a force with hysteresis",
    strength=Parameter("force", "fy", "N", 0.0, 500.0, 0.0, "yield force"),
    texts=(
        "z' = vL / xy * (1 - abs(z)**n * (gamma + 0.5 * sgn(vL * z)))",
        "S = S + fy * z",
    ),
    units={"S": "N"},
    shape=(
        Parameter(
            "yield_displacement",
            "xy",
            "m",
            1e-5,
            1e-2,
            5e-4,
            "displacement at yield",
            relative=0.2,
            of_motion=True,
            at_reversals=AtReversals.WAY,
        ),
        Parameter("exponent", "n", "1", 1.0, 5.0, 1.0, "sharpness of the yield"),
        Parameter(
            "gamma", "gamma", "1", -2.0, 2.0, 0.5, "γ/2β: at ½ it yields at fy, above it softens, below it hardens"
        ),
    ),
    looks="hysteresis loops of force over displacement; stiffness that falls with amplitude",
    source=(
        "Bouc 1967, Wen 1976: of z' = A v - β |v| |z|^(n-1) z - γ v |z|^n, with fy z for its z, "
        "A = fy/xy, β = A/(2 fy^n), γ = 2 β gamma"
    ),
    of_specimen=True,
    takes_over=("k0", "kS"),
    slides=True,
)

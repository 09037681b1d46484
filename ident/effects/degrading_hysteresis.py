"""The specimen yields, and weakens with the energy that it has dissipated, after Bouc, Wen, Baber and Noori."""

from ident.effects.effect import Effect
from ident.effects.needs import one_force_record
from ident.parameter import AtReversals, Parameter

DEGRADING_HYSTERESIS = Effect(
    name="degrading_hysteresis",
    place="load",
    meaning="the specimen yields, and loses strength and stiffness with the energy that it has dissipated",
    does="a force that yields and weakens",
    strength=Parameter("force", "fy", "N", 0.0, 500.0, 0.0, "yield force before any degradation"),
    texts=(
        "ed' = z * vL / xy",
        "z' = vL / xy * (1 - zeta * (1 - exp(-max(ed, 0))) * exp(-(z / 0.4)**2))"
        " * (1 - (1 + delta * max(ed, 0)) * abs(z) * (0.5 + 0.5 * sgn(vL * z))) / (1 + delta * max(ed, 0))",
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
        Parameter("degradation", "delta", "1", 1e-3, 1.0, 0.1, "loss of strength and stiffness for each energy fy xy"),
        Parameter("pinching", "zeta", "1", 0.02, 0.98, 0.3, "loss of stiffness near zero force after many cycles"),
    ),
    looks="loops of force over displacement that shrink from cycle to cycle, narrow at their middle",
    source=(
        "Baber and Wen 1981, Baber and Noori 1985, with ν = η = 1 + δ ε, ζ₁ = ζ (1 − exp(−ε)) and ζ₂ = 0.4: "
        "ε is the dissipated energy over fy xy"
    ),
    of_specimen=True,
    takes_over=("k0", "kS"),
    needs=one_force_record,
)

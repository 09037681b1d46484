"""The whole specimen sits behind a springy joint."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

SPECIMEN_JOINT = Effect(
    name="specimen_joint",
    place="load",
    meaning="an elastic joint connects the specimen to the rod",
    does="a spring in series",
    strength=Parameter("compliance", "s", "m/N", 0.0, 1e-5, 0.0, "compliance of the joint, 1/kj"),
    texts=(
        "tq := tp",
        "tp := th",
        "th := t",
        "Fq := Fp",
        "Fp := Fh",
        "dF = where(mL > 0, (Fp - Fq) / max(tp - tq, 1e-9), 0)",
        "xL = xL - s * (Fp + (t - tp) * dF)",
        "vL = vL - s * dF",
        "G = (mL * (D - R - f) / m0 + S + k * (x - xL)) / (1 + k * s + mL / m0)",
        "F = lag2(G, s * cL / (1 + k * s + mL / m0), s * mL / (1 + k * s + mL / m0))",
        "Fh := F",
        "a = (D - R - f - F) / m0 - aB",
        "M = m0 + where(s > 0, 0, mL)",
    ),
    units={"xL": "m", "vL": "m/s", "F": "N", "a": "m/s^2", "M": "kg"},
    looks="a second resonance that depends on the mass of the specimen; none without specimen",
    source="mL x2'' = kj (x - x2) - S, solved for F = kj (x - x2): regular for s = 1/kj = 0",
    of_specimen=True,
)

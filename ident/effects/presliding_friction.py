"""Friction that first yields like a spring, after Dahl."""

from ident.effects.effect import Effect
from ident.parameter import AtReversals, Parameter

PRESLIDING_FRICTION = Effect(
    name="presliding_friction",
    place="load",
    meaning="friction that acts as a spring before it slides (Dahl)",
    strength=Parameter("force", "Fd", "N", 0.0, 200.0, 0.0, "friction force while sliding"),
    texts=(
        "z := sgn(x - xr) + (z - sgn(x - xr)) * exp(-abs(x - xr) / xs)",
        "xr := x",
        "R = R + Fd * z",
    ),
    units={"R": "N"},
    shape=(
        Parameter(
            "displacement",
            "xs",
            "m",
            1e-7,
            1e-3,
            1e-5,
            "displacement over which the force builds up",
            relative=0.2,
            of_motion=True,
            at_reversals=AtReversals.WAY,
        ),
    ),
    looks="rounded hysteresis at every amplitude; at small amplitudes a stiffness instead of sticking",
    source="Dahl 1968: z' = (v - |v| z)/xs, here advanced exactly over the way of a step",
    steps=2,
    slides=True,
)

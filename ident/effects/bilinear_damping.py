"""The specimen's damper has another damping beyond a speed: its relief valves open."""

from ident.effects.effect import Effect
from ident.effects.needs import force_answers
from ident.parameter import Parameter

BILINEAR_DAMPING = Effect(
    name="bilinear_damping",
    place="load",
    meaning="the damping of the specimen changes at a speed, the same to both sides",
    does="a damping that changes at a speed",
    strength=Parameter("damping", "cb", "N*s/m", -1e8, 1e8, 0.0, "damping that is added beyond the speed"),
    texts=("S = S + cb * (vL - clip(vL, -vb, vb))",),
    units={"S": "N"},
    shape=(
        Parameter(
            "speed",
            "vb",
            "m/s",
            1e-4,
            1e1,
            1e-1,
            "speed at which the damping changes",
            searched=True,
            of_motion=True,
        ),
    ),
    looks="force over speed of two straight parts to each side",
    source="blow-off valves of a shock absorber, Dixon, The Shock Absorber Handbook",
    of_specimen=True,
    needs=force_answers,
)

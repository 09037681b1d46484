"""The specimen's spring has another stiffness beyond a displacement: a joint that opens, a gap that closes."""

from ident.effects.effect import Effect
from ident.effects.needs import force_answers
from ident.parameter import Parameter

BILINEAR_STIFFNESS = Effect(
    name="bilinear_stiffness",
    place="load",
    meaning="the stiffness of the specimen changes at a displacement, the same to both sides",
    does="a stiffness that changes at a displacement",
    strength=Parameter("stiffness", "kb", "N/m", -1e8, 1e8, 0.0, "stiffness that is added beyond the displacement"),
    texts=("S = S + kb * (xL - clip(xL, -xb, xb))",),
    units={"S": "N"},
    shape=(
        Parameter(
            "displacement",
            "xb",
            "m",
            1e-4,
            1e-1,
            1e-2,
            "displacement at which the stiffness changes",
            searched=True,
            of_motion=True,
        ),
    ),
    looks="force over displacement of two straight parts to each side, the same at every cycle",
    source="piecewise linear restoring force, as of a wall that rocks on its base",
    of_specimen=True,
    needs=force_answers,
)

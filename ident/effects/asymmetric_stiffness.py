"""The specimen's spring has another stiffness beyond a displacement, to that side alone: a bump stop, a slack cable."""

from ident.effects.effect import Effect
from ident.effects.needs import force_answers
from ident.parameter import Parameter

ASYMMETRIC_STIFFNESS = Effect(
    name="asymmetric_stiffness",
    place="load",
    meaning="the stiffness of the specimen changes at a displacement, to that side alone",
    does="a stiffness that differs between the sides",
    strength=Parameter("stiffness", "ka", "N/m", -1e8, 1e8, 0.0, "stiffness that is added beyond the displacement"),
    texts=("S = S + ka * max(xL - xa, 0)",),
    units={"S": "N"},
    shape=(
        Parameter(
            "displacement",
            "xa",
            "m",
            -1e-1,
            1e-1,
            0.0,
            "displacement at which the stiffness changes",
            searched=True,
            of_motion=True,
        ),
    ),
    looks="force over displacement of two straight parts, the same at every cycle: pull stiffer than push",
    source="piecewise linear restoring force, as of a brace that buckles, a cable that goes slack or a bump stop",
    of_specimen=True,
    needs=force_answers,
)

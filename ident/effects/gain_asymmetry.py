"""The flow gain differs between the directions, as with a single-rod cylinder."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

GAIN_ASYMMETRY = Effect(
    name="gain_asymmetry",
    place="spool",
    meaning="the flow gain differs between the directions, as with a single-rod cylinder",
    strength=Parameter(
        "asymmetry", "a", "1", -0.6, 0.6, 0.0, "relative difference of the flow gain of the two directions"
    ),
    texts=("w = w * (1 + a * sgn(w))",),
    units={"w": "m"},
    looks="one direction is faster than the other; even harmonics, and an offset that grows with amplitude",
    source="Strano and Terzo, slopes kqn and kqp",
)

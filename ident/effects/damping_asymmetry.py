"""Damping of one direction is larger than that of the other."""

from ident.effects.effect import Effect
from ident.effects.needs import force_answers
from ident.parameter import Parameter

DAMPING_ASYMMETRY = Effect(
    name="damping_asymmetry",
    place="load",
    meaning="damping is larger in one direction than in the other",
    strength=Parameter(
        "coefficient", "ca", "N*s/m", -2e4, 2e4, 0.0, "half of the difference between forward and backward damping"
    ),
    texts=("R = R + ca * abs(v)",),
    units={"R": "N"},
    looks="force over speed has two slopes, one for each direction",
    source="check valves of a damper that open one way: compression and rebound",
    needs=force_answers,
)

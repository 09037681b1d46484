"""The piston's area differs between the directions of motion."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

UNEQUAL_AREAS = Effect(
    name="unequal_areas",
    place="load",
    meaning="the piston area differs between extending and retracting, and with it flow and force",
    strength=Parameter(
        "asymmetry", "a", "1", -0.5, 0.5, 0.0, "relative difference of each piston area from their mean"
    ),
    texts=(
        "L = L + a * A * abs(v)",
        "D = D + max(a * A * P, 0) * sgn(v)",
        "Ff = Ff + max(-a * A * P, 0)",
    ),
    units={"L": "m^3/s", "D": "N", "Ff": "N"},
    looks="one direction is faster and weaker than the other; even harmonics, and an offset that grows with amplitude",
    source="single-rod cylinder, flow and force with A (1 + a sgn v); what opposes motion sticks",
    steps=4,
)

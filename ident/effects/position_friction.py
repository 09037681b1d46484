"""Dry friction grows away from the middle."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

POSITION_FRICTION = Effect(
    name="position_friction",
    place="load",
    meaning="dry friction that grows with the square of the way from the middle, and sticks",
    strength=Parameter(
        "curvature", "Fx", "N/m^2", 0.0, 2e8, 0.0, "dry friction for each square metre of way from zero"
    ),
    texts=("Ff = Ff + Fx * x**2",),
    units={"Ff": "N"},
    looks="flat tops at large displacements, none at small ones; damping that grows with amplitude",
    source="bent rod, seals and guides that are tighter towards the ends",
    steps=4,
)

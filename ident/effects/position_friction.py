"""Dry friction grows away from the middle."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

POSITION_FRICTION = Effect(
    name="position_friction",
    place="load",
    meaning="dry friction that grows with the square of the distance from the middle of the stroke",
    strength=Parameter("curvature", "Fx", "N/m^2", 0.0, 2e8, 0.0, "dry friction for each square metre of displacement"),
    texts=("Ff = Ff + Fx * x**2",),
    units={"Ff": "N"},
    looks="flat tops at large displacements only; damping that grows with amplitude",
    source="bent rod, seals and guides that are tighter towards the ends",
    steps=4,
    of_place=True,
)

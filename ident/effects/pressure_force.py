"""A measured pressure pushes on a piston in what is moved."""

from ident.effects.effect import Effect
from ident.effects.needs import force_answers
from ident.parameter import Parameter

PRESSURE_FORCE = Effect(
    name="pressure_force",
    place="load",
    meaning="the measured load pressure pushes the rod",
    strength=Parameter("area", "Ar", "m^2", -2e-2, 2e-2, 0.0, "area that the pressure acts on, positive along +x"),
    texts=("R = R - Ar * load_pressure",),
    units={"R": "N"},
    looks="the force rises and falls with the pressure, and so does its mean from run to run",
    source="F = A p of a pneumatic or hydraulic cylinder that is moved, with the channel load_pressure",
    needs=force_answers,
)

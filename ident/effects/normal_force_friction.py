"""Dry friction grows with a measured normal force."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

NORMAL_FORCE_FRICTION = Effect(
    name="normal_force_friction",
    place="load",
    meaning="dry friction in proportion to the measured vertical load",
    strength=Parameter("coefficient", "mu", "1", 0.0, 2.0, 0.0, "coefficient of friction"),
    texts=("Ff = Ff + mu * abs(vertical_load)",),
    units={"Ff": "N"},
    looks="flat tops that are wider while the load is high",
    source="Coulomb's law, F = mu N, with the channel vertical_load",
    steps=2,
    unless="Nv",
)

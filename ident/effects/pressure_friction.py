"""Dry friction of seals grows with a measured pressure."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

PRESSURE_FRICTION = Effect(
    name="pressure_friction",
    place="load",
    meaning="dry friction in proportion to the measured load pressure",
    strength=Parameter("area", "Af", "m^2", 0.0, 1e-2, 0.0, "dry friction for each unit of pressure"),
    texts=("Ff = Ff + Af * abs(load_pressure)",),
    units={"Ff": "N"},
    looks="flat tops that are wider while the pressure is high",
    source="seals that the pressure presses onto the rod; Armstrong-Hélouvry et al. 1994, section 2.1",
    steps=2,
)

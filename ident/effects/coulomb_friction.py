"""Dry friction of seals and guides, which sticks."""

from ident.effects.effect import Effect
from ident.parameter import AtReversals, Parameter

COULOMB_FRICTION = Effect(
    name="coulomb_friction",
    place="load",
    meaning="dry friction of seals and guides: the piston sticks at standstill",
    strength=Parameter("force", "Fc", "N", 0.0, 200.0, 0.0, "dry friction force", at_reversals=AtReversals.FORCE),
    texts=("Ff = Ff + Fc",),
    units={"Ff": "N"},
    looks="flat tops where the speed changes sign; less magnitude and more phase lag at small amplitudes",
    source="Strano and Terzo, Fc sgn v",
    steps=2,
    slides=True,
)

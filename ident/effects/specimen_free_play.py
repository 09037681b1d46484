"""The specimen's spring has play."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

SPECIMEN_FREE_PLAY = Effect(
    name="specimen_free_play",
    place="load",
    meaning="the spring of the specimen has free play",
    does="a spring with free play",
    strength=Parameter("half_width", "g", "m", 0.0, 2e-3, 0.0, "half of the play", of_motion=True),
    texts=("xk = xk - clip(xk, -g, g)",),
    units={"xk": "m"},
    looks="no stiffness at small displacements, full stiffness beyond; only with springs",
    source="clearance in the joint to the spring",
    of_specimen=True,
)

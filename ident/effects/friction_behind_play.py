"""Dry friction that a play lies before: what rubs is moved only when the play is taken up."""

from ident.effects.effect import Effect
from ident.effects.needs import force_answers
from ident.parameter import AtReversals, Parameter, Starts

FRICTION_BEHIND_PLAY = Effect(
    name="friction_behind_play",
    place="load",
    meaning="dry friction behind a play: after each reversal there is no friction until the play is closed",
    strength=Parameter("force", "Fp", "N", 0.0, 200.0, 0.0, "dry friction force", at_reversals=AtReversals.FORCE),
    texts=(
        "d := clip(d + x - xr, -g, g)",
        "xr := x",
        "Ff = Ff + Fp * where(d * v < 0.999999 * g * abs(v), 0, 1)",
    ),
    units={"Ff": "N"},
    shape=(
        Parameter(
            "half_width",
            "g",
            "m",
            1e-4,
            1.01e-2,
            1e-3,
            "half of the play",
            relative=0.2,
            of_motion=True,
            start=Starts.FINELY,
            at_reversals=AtReversals.WAY,
        ),
    ),
    looks="after each reversal no friction over the width of the play, then full friction at once",
    source="play operator before Coulomb friction: a friction damper with clearance in its joints",
    steps=2,
    needs=force_answers,
)

"""Dry friction that a play lies before: what rubs is moved, by a spring of contact, only when the play is taken up."""

from ident.effects.effect import Effect
from ident.effects.needs import force_answers
from ident.parameter import AtReversals, Parameter, Starts

FRICTION_BEHIND_PLAY = Effect(
    name="friction_behind_play",
    place="load",
    meaning="dry friction behind a play: after each reversal there is no friction until the play is closed",
    strength=Parameter("force", "Fp", "N", 0.0, 200.0, 0.0, "dry friction force"),
    texts=(
        "d := clip(d + x - xr, -g - xs, g + xs)",
        "xr := x",
        "R = R + Fp * (d - clip(d, -g, g)) / xs",
    ),
    units={"R": "N"},
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
        Parameter(
            "contact",
            "xs",
            "m",
            1e-6,
            1e-2,
            1e-5,
            "displacement of the contact, over which the force builds up when the play is closed",
            relative=0.002,
            of_motion=True,
        ),
    ),
    looks="after each reversal no force over the width of the play, then friction, at once or over the contact's way",
    source="a play, a spring and a slider in series (Jenkins element): a friction damper with clearance in its joints",
    steps=2,
    needs=force_answers,
    slides=True,
)

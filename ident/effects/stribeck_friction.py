"""More friction at standstill than in motion."""

from ident.effects.effect import Effect
from ident.parameter import AtReversals, Parameter

STRIBECK_FRICTION = Effect(
    name="stribeck_friction",
    place="load",
    meaning="friction is larger at standstill than in motion",
    strength=Parameter(
        "force", "dF", "N", 0.0, 200.0, 0.0, "breakaway force above sliding friction", at_reversals=AtReversals.FORCE
    ),
    texts=("Ff = Ff + dF * exp(-(v / vs)**2)",),
    units={"Ff": "N"},
    shape=(
        Parameter(
            "speed",
            "vs",
            "m/s",
            1e-4,
            0.5,
            5e-3,
            "speed at which the excess falls to 1/e",
            of_motion=True,
            at_reversals=AtReversals.SPEED,
        ),
    ),
    looks="sticking and jumps at small amplitudes and low frequency",
    source="Stribeck; Armstrong-Helouvry et al. 1994",
    steps=2,
)

"""The drive signal is limited to 1/a."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

COMMAND_LIMIT = Effect(
    name="command_limit",
    place="controller",
    meaning="the drive signal is limited to 1/a",
    strength=Parameter("inverse_limit", "a", "1/m", 0.0, 200.0, 0.0, "inverse of the largest drive signal"),
    texts=("e = clip(e, -1 / max(a, 1e-9), 1 / max(a, 1e-9))",),
    units={"e": "m"},
    looks="clipped speed, more phase lag and less magnitude at large amplitudes and gains, none at small ones",
    source="Khalil, Nonlinear Systems, saturation",
    steps=2,
)

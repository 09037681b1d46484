"""What draws an output back grows faster than the output."""

from ident.effects.effect import Effect
from ident.effects.needs import no_speed
from ident.parameter import Parameter

PROGRESSIVE_LOSS = Effect(
    name="progressive_loss",
    place="load",
    meaning="what draws the output back grows faster than the output: radiated heat, or free convection",
    does="a loss that grows faster than the output",
    strength=Parameter(
        "inverse_output",
        "b",
        "1/m",
        0.0,
        1e3,
        0.0,
        "inverse of the output at which the loss has doubled",
        of_motion=True,
    ),
    texts=("xo = xo + b * x * abs(x)",),
    units={"xo": "m"},
    looks="large steps that settle sooner, and lower than in proportion",
    source="free convection and radiation, Incropera and DeWitt, Heat and Mass Transfer, chapters 9 and 12",
    needs=no_speed,
    unless="tau1",
)

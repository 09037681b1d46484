"""The command acts late, outside the loop."""

from ident.effects.effect import Effect
from ident.parameter import Parameter, Starts

COMMAND_DELAY = Effect(
    name="command_delay",
    place="controller",
    meaning="the command acts late, outside the loop",
    strength=Parameter("delay", "T", "s", 0.0, 5e-3, 0.0, "time by which the command acts late", start=Starts.TIME),
    texts=("r = delay(r, T)",),
    units={"r": ""},
    looks="phase that falls in proportion to frequency, the same at every gain and specimen; magnitude untouched",
    source="transport delay",
)

"""The command acts late, outside the loop."""

from ident.effects.effect import Effect
from ident.parameter import Parameter, Starts

COMMAND_DELAY = Effect(
    name="command_delay",
    place="controller",
    meaning="the command acts after a delay, outside the loop",
    strength=Parameter("delay", "T", "s", 0.0, 5e-3, 0.0, "delay of the command", start=Starts.TIME),
    texts=("r = delay(r, T)",),
    units={"r": ""},
    looks="phase lag in proportion to frequency, the same at every gain and specimen; the magnitude does not change",
    source="transport delay",
)

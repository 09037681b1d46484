"""What rises falls at another rate."""

from ident.effects.effect import Effect
from ident.effects.needs import one_sided_command
from ident.parameter import Parameter

SPEED_ASYMMETRY = Effect(
    name="speed_asymmetry",
    place="load",
    meaning="the output rises with one time constant and falls with another",
    strength=Parameter("asymmetry", "a", "1", -0.9, 0.9, 0.0, "relative difference of the rising speed from the mean"),
    texts=("v = v * (1 + a * sgn(xi - xo))",),
    units={"v": "m/s"},
    looks="a fast rise and a slow fall at every amplitude",
    source="a drive that acts in one direction only, such as a pump, a heater or a motor behind one transistor",
    needs=one_sided_command,
)

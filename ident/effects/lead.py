"""The controller adds the rate of the error."""

from ident.effects.effect import Effect
from ident.parameter import Parameter, Starts

LEAD = Effect(
    name="lead",
    place="controller",
    meaning="the controller has derivative action, too",
    strength=Parameter("time", "Td", "s", 0.0, 5e-3, 0.0, "derivative time", start=Starts.TIME),
    texts=("e = e + Kp * Td * (dr - v_in)",),
    units={"e": "m"},
    looks="more bandwidth and damping than the gain explains; the difference grows with frequency",
    source="PD control",
)

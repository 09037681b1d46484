"""The supply sags where much flow is drawn."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

SUPPLY_DROOP = Effect(
    name="supply_droop",
    place="flow",
    meaning="the supply pressure drops when the actuator draws much flow",
    does="less speed at large flow",
    strength=Parameter("droop", "d", "s/m^3", 0.0, 1e4, 0.0, "relative loss of flow for each m^3/s of flow"),
    texts=(
        "Q = Q * (1 - d * z)",
        "z' = (abs(Q) - z) / T",
    ),
    units={"Q": "m^3/s"},
    shape=(Parameter("time_constant", "T", "s", 5e-3, 5.0, 0.1, "time constant of the supply"),),
    looks="a gain that falls some tenths of a second after large motions, and recovers",
    source="pump and accumulator behind the valve",
)

"""The leakage differs between the directions of the load."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

ONE_WAY_LEAKAGE = Effect(
    name="one_way_leakage",
    place="pressure",
    meaning="the leakage differs between the directions of the load; in the extreme one direction has none",
    does="leakage in one direction of the load only",
    strength=Parameter("coefficient", "c", "m^3/(s*Pa)", -2e-11, 2e-11, 0.0, "difference of the leakage from its mean"),
    texts=("L = L + c * abs(P)",),
    units={"L": "m^3/s"},
    looks="a drift in one direction under alternating loads; even harmonics",
    source="check valves, a seal that lifts; what leaks l more one way is l/2 of Cl and l/2 of this",
)

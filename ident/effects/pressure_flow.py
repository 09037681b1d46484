"""The flow depends on the pressure that is left across the valve."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

PRESSURE_FLOW = Effect(
    name="pressure_flow",
    place="flow",
    meaning="the flow depends on the pressure drop across the valve",
    does="less speed under load",
    strength=Parameter("inverse_supply", "r", "1/Pa", 0.0, 5e-7, 0.0, "inverse of the supply pressure, 1/Ps"),
    texts=("Q = Q * sqrt(max(0, 1 - sgn(w) * P * r))",),
    units={"Q": "m^3/s"},
    looks="less flow against the load than with it; more with a heavy specimen and a large amplitude; odd harmonics",
    source="Qian et al. 2014, section 2.1.2; Strano and Terzo, square-root flow",
)

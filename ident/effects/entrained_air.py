"""Air in the oil makes it softer at low pressure."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

ENTRAINED_AIR = Effect(
    name="entrained_air",
    place="pressure",
    meaning="air in the oil lowers its bulk modulus at low pressure",
    does="less stiffness at low load",
    strength=Parameter(
        "content", "alpha", "1", 0.0, 5.0, 0.0, "relative compressibility that the air adds at low pressure"
    ),
    texts=("Ke = Ke * (1 + alpha / (1 + (P / Pr)**2))",),
    units={"Ke": "m^3/Pa"},
    shape=(Parameter("pressure", "Pr", "Pa", 1e5, 2e7, 2e6, "pressure at which half of the effect is left"),),
    looks="the oil-column resonance rises with amplitude and load",
    source="phenomenological; effective bulk modulus",
)

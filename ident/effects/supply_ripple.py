"""The pump's pulsation modulates the flow."""

from ident.effects.effect import Effect
from ident.parameter import Parameter, Starts

SUPPLY_RIPPLE = Effect(
    name="supply_ripple",
    place="flow",
    meaning="the pulsation of the pump modulates the flow",
    does="a gain that pulsates",
    strength=Parameter("depth", "r", "1", 0.0, 0.5, 0.0, "relative modulation of the flow"),
    texts=("Q = Q * (1 + r * sin(2 * pi * f * t + phi))",),
    units={"Q": "m^3/s"},
    shape=(
        Parameter(
            "frequency",
            "f",
            "1/s",
            3.0,
            300.0,
            25.0,
            "frequency of the pulsation",
            searched=True,
            start=Starts.SPECTRAL_LINES,
        ),
        Parameter(
            "phase",
            "phi",
            "1",
            -6.3,
            6.3,
            0.0,
            "phase of the pulsation at the start of the record",
            searched=True,
            start=Starts.PHASE,
        ),
    ),
    looks="each spectral line of the motion has two sidebands, at a distance of the pump frequency",
    source="pump without accumulator; one phase for all runs, so runs begun at one angle of the pump or a single run",
)

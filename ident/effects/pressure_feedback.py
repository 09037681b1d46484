"""The load pressure is fed back to damp the oil column."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

PRESSURE_FEEDBACK = Effect(
    name="pressure_feedback",
    place="controller",
    meaning="the load pressure is fed back to damp the oil column",
    does="damping from the load, fed back",
    strength=Parameter("gain", "kd", "m/Pa", 0.0, 1e-9, 0.0, "gain from load pressure to drive signal"),
    texts=("e = e - kd * P",),
    units={"e": "m"},
    looks="a flatter oil-column resonance; like more leakage, but behind the valve's lag",
    source="Merritt, Hydraulic Control Systems, dynamic pressure feedback",
)

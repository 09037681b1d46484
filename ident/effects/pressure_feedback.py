"""The load pressure is fed back to damp the oil column."""

from ident.effects.effect import Effect
from ident.parameter import Parameter

PRESSURE_FEEDBACK = Effect(
    name="pressure_feedback",
    place="controller",
    meaning="the controller feeds the load pressure back, which damps the oil column",
    does="feedback of the load that adds damping",
    strength=Parameter("gain", "kd", "m/Pa", 0.0, 1e-9, 0.0, "gain from load pressure to drive signal"),
    texts=("e = e - kd * P",),
    units={"e": "m"},
    looks="a lower oil-column resonance, as with more leakage, but after the lag of the valve",
    source="Merritt, Hydraulic Control Systems, dynamic pressure feedback",
)

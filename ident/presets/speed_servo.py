"""An electric drive that turns a load under a speed loop, command → speed."""

from dataclasses import replace

from ident.presets.description import described
from ident.presets.machine import composed
from ident.presets.preset import Combined

_MADE = composed(
    described({"controller": "pi", "of": "velocity", "load": "mass_spring_damper", "sensor": ["velocity"]}),
    "speed_servo",
    "Motor under a speed loop",
)

SPEED_SERVO = replace(
    _MADE,
    citation="K. J. Åström, R. M. Murray: Feedback Systems. Princeton University Press (2021), section 11.3 (PI "
    "control of a first-order process): J ω' + c ω = K e, e = Kp (r − ω) + KI ∫ (r − ω) dt.",
    combinations=(
        Combined("Kt / m0", "1/s", "proportional gain of the loop over the inertia, for Kp = 1"),
        Combined("Kt * KI / m0", "1/s^2", "integral gain of the loop over the inertia, for Kp = 1"),
        Combined("c0 / m0", "1/s", "damping over the inertia"),
    ),
    data=replace(_MADE.data, turns=True),
)

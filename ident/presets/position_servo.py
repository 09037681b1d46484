"""An electric servo: a motor that turns a load under a position loop, command → angle."""

from dataclasses import replace

from ident.presets.description import described
from ident.presets.machine import composed
from ident.presets.preset import Combined

_MADE = composed(
    described({"controller": "p", "of": "displacement", "load": "mass_spring_damper", "sensor": ["displacement"]}),
    "position_servo",
    "Motor under a position loop",
)

POSITION_SERVO = replace(
    _MADE,
    citation="G. F. Franklin, J. D. Powell, A. Emami-Naeini: Feedback Control of Dynamic Systems. Pearson, section "
    "2.3 (DC motor) under proportional control: J θ'' + c θ' = K Kp (r − θ), with c of friction and induced voltage.",
    combinations=(
        Combined("Kt / m0", "1/s^2", "stiffness of the loop over the inertia, for Kp = 1"),
        Combined("Kt / c0", "1/s", "speed gain of the loop, for Kp = 1"),
        Combined("c0 / m0", "1/s", "damping over the inertia"),
    ),
    data=replace(_MADE.data, turns=True),
)

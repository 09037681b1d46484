"""What the catalogue does not hold, as a user would write it: the equations of tests/reference/outside_reference."""

from __future__ import annotations

from typing import Any

from ident.custom.definition import read_effect
from ident.effects.effect import Effect

_TEXTS: dict[str, tuple[str, str, str, float]] = {
    "flow_force": ("valve", "dq = dq - s * q1 * abs(P) / 1e6 / tau", "1", 2.0),
    "gain_drift": ("flow", "Q = Q * (1 + s * t)", "1/s", 1.0),
    "pump_ripple": ("flow", "Q = Q * (1 + s * sin(2 * pi * 23 * t))", "1", 1.0),
    "position_friction": ("load", "R = R + s * (x / 2e-3)**2 * tanh(v / 2e-4)", "N", 1000.0),
    "sensor_curve": ("sensor", "y = y * (1 + s * (X / 2e-3)**2)", "1", 1.0),
}
"""Place, equation, unit and largest strength. The gain that follows a temperature is none: nobody recorded it."""
WRITTEN = tuple(_TEXTS)


def written(name: str) -> Effect:
    """The effect of that name."""
    place, equation, unit, upper = _TEXTS[name]
    definition: dict[str, Any] = {
        "name": name, "place": place, "equation": equation,
        "strength": {"symbol": "s", "unit": unit, "lower": 0, "upper": upper}, "meaning": f"{name}, written down",
    }  # fmt: skip
    return read_effect(definition)

"""What the catalogue does not hold, as a user would write it: the equations of tests/reference/outside_reference."""

from __future__ import annotations

from typing import Any

from ident.custom.definition import read_effect
from ident.effects.effect import Effect

_TEXTS: dict[str, tuple[str, str, str, float]] = {
    "gain_drift": ("flow", "Q = Q * (1 + s * t)", "1/s", 1.0),
    "sensor_curve": ("sensor", "y = y * (1 + s * (X / 2e-3)**2)", "1", 1.0),
    "loaded_lag": ("valve", "dq = dq / (1 + s * abs(P) / 1e6)", "1", 5.0),
    "gain_bump": ("flow", "Q = Q * (1 + s * exp(-((x - 5e-4) / 5e-4)**2))", "1", 2.0),
    "relief_leakage": ("pressure", "L = L + s * Cl * sgn(P) * max(abs(P) - 5e5, 0)", "1", 20.0),
    "growing_friction": ("load", "R = R + s * t * tanh(v / 2e-4)", "N/s", 1000.0),
    "position_damping": ("load", "R = R + s * (x / 2e-3)**2 * v", "N*s/m", 1e5),
}
"""Place, equation, unit and largest strength. The gain that follows a temperature is none: nobody recorded it."""
WRITTEN = tuple(_TEXTS)


def written(name: str) -> Effect:
    """The effect of that name."""
    place, equation, unit, upper = _TEXTS[name]
    definition: dict[str, Any] = {
        "name": name,
        "place": place,
        "equation": equation,
        "strength": {"symbol": "s", "unit": unit, "lower": 0, "upper": upper},
        "meaning": f"{name}, written down",
    }
    return read_effect(definition)

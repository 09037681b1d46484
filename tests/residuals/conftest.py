"""Matrices of the independent reference with one hidden effect, beside the linear model that made the rest."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from ident.comparison.compare import Comparison, compare
from ident.fit.settings import Settings
from ident.presets import preset
from ident.workflows import identify
from tests.fit.recovery import matrix

HIDDEN = {
    "dead_zone": 2e-4,
    "coulomb_friction": 25.0,
    "pressure_flow": 9e-8,
    "quadratic_damping": 5000.0,
    "gain_asymmetry": 0.05,
    "backlash": 2e-4,
}
"""Strengths at which the linear model is a few per cent off."""
TRUE = {p.name: p.value for p in preset("qian2014").parameters}


@cache
def compared(name: str, strength: float | None = None, all_amplitudes: bool = False, **changed: float) -> Comparison:
    """Twelve runs of 1 s with a hidden effect against the linear model at the true values, or at others.

    With `all_amplitudes`, 24 runs of eight conditions at three amplitudes each, the model fitted.
    """
    force = HIDDEN[name] if strength is None else strength
    if all_amplitudes:
        whole = matrix(name, force, 5, 1.0)
        data = replace(whole, runs=whole.runs[:24])
        return compare(data, identify(data, Settings()))
    data = matrix(name, force, 5, 1.0, 7)
    return compare(data, identify(data, Settings(fixed=TRUE | changed)))

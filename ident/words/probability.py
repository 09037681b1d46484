"""Probabilities in per cent, never as certain: what is said at 99 % and more is "over 99 %"."""

from __future__ import annotations

_LEAST, _MOST = 0.01, 0.99  # beyond which the trials that a probability was calibrated on say nothing finer


def probability_said(p: float | None) -> str:
    """Two digits, 0.874 → "87 %", 0.9999 → "over 99 %", 1e-5 → "under 1 %"; a dash where it is not known."""
    if p is None:
        return "–"
    if p > _MOST:
        return f"over {100 * _MOST:.0f} %"
    return f"under {100 * _LEAST:.0f} %" if p < _LEAST else f"{100 * p:.0f} %"

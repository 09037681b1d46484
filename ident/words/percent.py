"""Fractions in per cent, as every table, sentence and figure says them."""

from __future__ import annotations

import math


def percent(fraction: float | None, unknown: str = "–") -> str:
    """Three significant digits, 0.005 → "0.500 %"; `unknown` where there is no number."""
    if fraction is None or not math.isfinite(fraction):
        return unknown
    return f"{100 * fraction:#.3g}".rstrip(".") + " %"

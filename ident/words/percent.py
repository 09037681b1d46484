"""Fractions in per cent, as every table, sentence and figure says them."""

from __future__ import annotations

import math

from ident.words.number import fixed, places

_DECIMALS = 3  # in print, where a column of numbers stays narrow


def percent(fraction: float | None, unknown: str = "–", minus: str = "-") -> str:
    """Three significant digits, 0.005 → "0.500 %"; `unknown` where there is no number."""
    if fraction is None or not math.isfinite(fraction):
        return unknown
    return f"{100 * fraction:#.3g}".rstrip(".").replace("-", minus) + " %"


def percent_in_print(fraction: float | None, digits: int = 3) -> str:
    """As pages and reports set it: a true minus, and never more than three decimals, 2.8e-7 → "0.000 %"."""
    if fraction is None or not math.isfinite(fraction):
        return "–"
    decimals = min(_DECIMALS, places(100 * fraction, digits)) if fraction else _DECIMALS
    return f"{fixed(100 * fraction, decimals)} %"


def change(share: float, sign: str = "-") -> str:
    """A relative change to a tenth of a per cent, −0.0663 → "−6.6 %"; with "+" as `sign` a rise has its sign too."""
    rounded = round(100 * share, 1) or 0.0  # never a minus before nothing
    return f"{rounded:{sign}.1f} %".replace("-", "−")

"""Fractions and probabilities in per cent, as tables, sentences and figures say them; large ones as so many times."""

from __future__ import annotations

import math

from ident.words.number import fixed, places, plain

PER_CENT = 100.0
"""Of a whole. No answer depends on it: a unit."""
_DECIMALS = 3  # in print, where a column of numbers stays narrow
TIMES = 9.995
"""The fraction, 1, from which on it is said as so many times: no per cent of four digits is ever printed.

It is 10 less what rounds up to it in three digits. "2317 %" has to be converted by its reader, "23.2 times" is read.
"""
_LEAST_SURE, _MOST_SURE = 0.01, 0.99  # beyond which the trials that a probability was calibrated on say nothing finer


def percent(fraction: float | None, unknown: str = "–", minus: str = "-") -> str:
    """Three significant digits, 0.005 → "0.500 %", 12.3 → "12.3 times"; `unknown` where there is no number."""
    if fraction is None or not math.isfinite(fraction):
        return unknown
    if abs(fraction) >= TIMES:
        return _times(fraction, minus)
    return f"{100 * fraction:#.3g}".rstrip(".").replace("-", minus) + " %"


def percent_in_print(fraction: float | None, digits: int = 3) -> str:
    """As pages and reports set it: a true minus, and never more than three decimals, 2.8e-7 → "0.000 %"."""
    if fraction is None or not math.isfinite(fraction):
        return "–"
    if abs(fraction) >= TIMES:
        return _times(fraction)
    decimals = min(_DECIMALS, places(100 * fraction, digits)) if fraction else _DECIMALS
    return f"{fixed(100 * fraction, decimals)} %"


def change(share: float, sign: str = "-") -> str:
    """A relative change to a tenth of a per cent, −0.0663 → "−6.6 %"; with "+" as `sign` a rise has its sign too.

    What grew to ten times and more is said so: 23.18 → "24.2 times".
    """
    if abs(share) >= TIMES:
        return _times(share + 1.0)
    rounded = round(100 * share, 1) or 0.0  # never a minus before nothing
    return f"{rounded:{sign}.1f} %".replace("-", "−")


def _times(fraction: float, minus: str = "−") -> str:
    """ "12.3 times"."""
    return f"{plain(fraction, 3).replace('−', minus)} times"


def probability_said(p: float | None) -> str:
    """A probability, never as certain: 0.874 → "87 %", 0.9999 → "over 99 %", 1e-5 → "under 1 %".

    A dash where it is not known.
    """
    if p is None:
        return "–"
    if p > _MOST_SURE:
        return f"over {100 * _MOST_SURE:.0f} %"
    return f"under {100 * _LEAST_SURE:.0f} %" if p < _LEAST_SURE else f"{100 * p:.0f} %"

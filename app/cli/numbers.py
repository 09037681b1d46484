"""Numbers as the command line prints them."""

from __future__ import annotations


def percent(value: float | None) -> str:
    """A fraction in per cent with three significant digits, 0.005 → "0.500 %"; a dash where there is none."""
    return "–" if value is None else f"{100 * value:#.3g}".rstrip(".") + " %"

"""The interval of a rate."""

from __future__ import annotations

from scipy.stats import beta


def interval(hits: int, trials: int) -> tuple[float, float]:
    """The exact 95 % interval of a rate (Clopper and Pearson 1934)."""
    lower = float(beta.ppf(0.025, hits, trials - hits + 1)) if hits else 0.0
    upper = float(beta.ppf(0.975, hits + 1, trials - hits)) if hits < trials else 1.0
    return lower, upper

"""The interval of a rate."""

from __future__ import annotations

from scipy.stats import beta


def interval(hits: int, trials: int) -> tuple[float, float]:
    """The exact 95 % interval of a rate (Clopper and Pearson 1934)."""
    lower = float(beta.ppf(0.025, hits, trials - hits + 1)) if hits else 0.0
    upper = float(beta.ppf(0.975, hits + 1, trials - hits)) if hits < trials else 1.0
    return lower, upper


def rate(right: list[bool]) -> str:
    """How often something was right, as a count with its interval."""
    lower, upper = interval(sum(right), len(right))
    return f"{sum(right)} of {len(right)} ({100 * lower:.0f} to {100 * upper:.0f} %)"


def rate_line(what: str, hits: int, trials: int, goal: str) -> str:
    """A row of a table: what was counted, how often it was so, the rate with its interval, and the goal."""
    lower, upper = interval(hits, trials)
    rate = f"{100 * hits / trials:.1f} ({100 * lower:.1f}-{100 * upper:.1f})"
    return f"| {what} | {hits} of {trials} | {rate} | {goal} |"

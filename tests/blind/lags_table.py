"""The table of trials of what follows like a lag: what was right, of those whose records show it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from tests.blind.campaign import OUT
from tests.blind.interval import rate_line

HIDDEN = ("drive_hysteresis", "backlash", "second_capacity", "dead_zone", "")
ROWS = OUT.with_name("blind-lags.jsonl")


def lag_rates(everything: Sequence[dict[str, Any]]) -> Iterable[str]:
    """Counts with 95 % intervals by what is hidden, and what was missed."""
    shown = [row for row in everything if row["shown"]]
    yield "| hidden | right | rate in % (95 % interval) | goal in % |"
    yield "|---|---|---|---|"
    for hidden in HIDDEN:
        if of := [row["right"] for row in shown if row["hidden"] == hidden]:
            yield rate_line(hidden or "nothing", sum(of), len(of), "90" if hidden else "97")
    yield rate_line("taken for a lag", sum(row["structure"] for row in shown), len(shown), "90")
    yield f"\nOf {len(everything)} trials {len(everything) - len(shown)} were dropped: their records do not show it."
    for row in shown:
        if not row["right"]:
            said = ", ".join(row["effects"]) or "nothing"
            yield f"\nMissed: seed {row['seed']}, {row['hidden'] or 'nothing'}: {said}, {row['model']}."

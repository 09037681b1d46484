"""The tables of fresh trials of every kind: how often each was right, and how sure the verdicts were."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from tests.blind.campaign import OUT
from tests.blind.interval import interval
from tests.blind.reliability import said, table

FRESH = OUT.with_name("blind-fresh.jsonl")
GOALS: dict[str, float | None] = {
    "one": 99, "two": 98, "three": 98, "none": 98, "machine": 95, "machine, nothing hidden": 97, "periodic": 95,
    "periodic, nothing hidden": 97, "noise": 98, "unlisted": None, "label": 95, "left out": None, "clutter": 95,
}  # fmt: skip
"""The rate in % that is asked for, by kind of trial."""
Row = dict[str, Any]


def counts(row: Row) -> bool:
    """Whether a trial counts: something was said, and what is hidden shows in the records."""
    return row["right"] is not None and not (row.get("counts") is False and row.get("hidden"))


def fresh(everything: Sequence[Row]) -> Iterable[str]:
    """What came out, by kind."""
    yield "| trial | right | rate in % (95 % interval) | goal in % | mean probability | seconds (median) |"
    yield "|---|---|---|---|---|---|"
    for name, goal in GOALS.items():
        found = [row for row in everything if row["trial"] == name and counts(row)]
        if found:
            hits = sum(bool(row["right"]) for row in found)
            lower, upper = interval(hits, len(found))
            known = [row["probability"] for row in found if row.get("probability") is not None]
            sure = f"{np.mean(known):.2f}" if known else "–"
            yield (
                f"| {name} | {hits} of {len(found)} | {100 * hits / len(found):.1f} ({100 * lower:.0f}-"
                f"{100 * upper:.0f}) | {goal or '–'} | {sure} | {np.median([r['seconds'] for r in found]):.0f} |"
            )
    for row in everything:
        if counts(row) and not row["right"]:
            told = row.get("failed") or row.get("found", row.get("effects", row.get("named")))
            yield f"\nMissed: {row['trial']}, seed {row['seed']}: {row['hidden'] or 'nothing'} hidden, said {told}."
    yield "\nHow sure a verdict was against whether it was right:\n"
    yield from table(said(everything))

"""The table of trials of machines of many kinds: what was right, of those whose records show it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any

from tests.blind.campaign import OUT
from tests.blind.interval import rate_line

ROWS = OUT.with_name("blind-various.jsonl")
Row = dict[str, Any]
FAULTS = ("missing input", "self-oscillation")
CREPT = 168330
"""The last seed whose dry friction crept at 1 % of the usual speed; it now does at a ten-thousandth."""


def rates(everything: Sequence[Row]) -> Iterable[str]:
    """Counts with 95 % intervals, and what was missed."""
    tried = [row for row in everything if "checks" not in row]
    shown = [row for row in tried if row["shown"]]
    machines = [row for row in shown if row["hidden"] not in FAULTS and "failed" not in row]
    yield "| what | right | rate in % (95 % interval) | goal in % |"
    yield "|---|---|---|---|"
    for what, goal, right in (
        ("the structure", "90", [row["structure"] for row in machines]),
        ("the hidden effect named", "90", [row["named"] for row in machines if row["hidden"]]),
        (
            f"the same after seed {CREPT}",
            "90",
            [row["named"] for row in machines if row["hidden"] and row["seed"] > CREPT],
        ),
        ("nothing named where nothing is hidden", "97", [row["named"] for row in machines if not row["hidden"]]),
        ("a missing input said", "95", [row["named"] for row in shown if row["hidden"] == FAULTS[0]]),
        ("a missing input said wrongly", "at most 2", [row["missing"] for row in machines]),
        (
            "an oscillation said, its frequency within 2 %",
            "–",
            [row["named"] for row in shown if row["hidden"] == FAULTS[1]],
        ),
        ("an oscillation said wrongly", "–", [row["swings"] for row in machines]),
        ("failed", "0", ["failed" in row for row in shown]),
    ):
        if right:
            yield rate_line(what, sum(right), len(right), goal)
    yield f"\nOf {len(tried)} trials {len(tried) - len(shown)} were dropped: their records do not show it."
    yield f"\nUp to seed {CREPT} the dry friction of the machines crept, by more than the noise in some."
    for row in shown:
        if not row["named"] or row.get("structure") is False:
            said = row.get("failed") or ", ".join(row["effects"]) or "nothing"
            model = f"; taken for {row['model']}" if row.get("structure") is False else ""
            yield f"\nMissed: seed {row['seed']}, {row.get('kind')}, {row['hidden'] or 'nothing'}: {said}{model}."
    for row in everything:
        if "checks" in row:
            yield from _checks(row)


def _checks(row: Row) -> Iterable[str]:
    """What `check` alone said of records that lack an input or oscillate, and of such as do not."""
    counts: Counter[str] = Counter(row["checks"])
    first, last = row["seeds"]
    yield f"\nThe checks alone, seeds {first} to {last}, whose records no rule was chosen by:\n"
    yield "| what | said | rate in % (95 % interval) | goal in % |"
    yield "|---|---|---|---|"
    for what, of, said, goal in (
        ("an input that is missing", "lacks an input", "said", "95"),
        ("an input that is missing, said wrongly", "lacks none", "said", "at most 2"),
        (
            "an oscillation under a command at rest, steps or a slow sine, its frequency within 2 %",
            "oscillates",
            "within 2 %",
            "–",
        ),
        ("an oscillation under noise, its frequency within 2 %", "oscillates under noise", "within 2 %", "–"),
        (
            "an oscillation under noise that does not put it out, its frequency within 2 %",
            "lasts under noise",
            "within 2 %",
            "–",
        ),
        ("an oscillation that the command puts out", "is put out", "said", "–"),
        ("an oscillation of a stable loop", "stable", "said", "–"),
        ("an oscillation of a stable loop under noise", "stable under noise", "said", "–"),
    ):
        if counts[of]:
            yield rate_line(what, counts[f"{of}, {said}"], counts[of], goal)

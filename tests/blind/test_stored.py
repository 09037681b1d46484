"""What is said of the trials that are kept: an effect that is named takes a share that matters of what could be."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from ident.diagnosis.criteria import CRITERIA
from tests.blind.campaign import OUT, rows
from tests.blind.fresh_table import FRESH
from tests.blind.machines import OFFSET
from tests.blind.table import PAGE, PERIODIC, page

Row = dict[str, Any]


def steps(row: Row) -> Iterator[tuple[str, float, float, float]]:
    """Each step of a trial: what was added, the error before and after, and the noise floor, in one unit."""
    if row.get("steps"):
        floor = row.get("floor") if "found" in row else (row.get("floor") or 1.0) * row["noise"]
        for (_, before), (added, after) in pairwise(row["steps"]):
            if added not in OFFSET and before and after:
                yield added, before, after, floor or 0.0
    elif "periods" in row and len(row.get("named", [])) == 1:
        yield row["named"][0], row["linear"], row["errors"]["fit"], row["floor"] or 0.0


def test_no_effect_is_named_that_takes_less_than_a_hundredth_of_what_could_be_explained() -> None:
    """Where no floor is known all of the error is to be explained."""
    seen = 0
    for row in (*rows(PERIODIC), *rows(FRESH)):
        for added, before, after, floor in steps(row):
            explainable = before**2 - min(floor, after) ** 2
            share = (before**2 - after**2) / explainable
            assert share > CRITERIA.evidence.share, (row["seed"], added, share)
            seen += 1
    assert seen > 100


def members(row: Row) -> Iterator[tuple[str, float]]:
    """Each effect that was said to explain as much as a named one, and by how much its gain is less, in nats."""
    named = row["found"] if "found" in row else row.get("named", [])
    gains = {frozenset(effects): nats for effects, nats in row.get("effect_sets", ())}
    for group in row.get("groups", ()):
        own = [name for name in named if name in group]
        for name in {*group} - {*named} if len(own) == 1 else ():
            instead = gains.get(frozenset({*named} - {*own} | {name}))
            if instead is not None and frozenset(named) in gains:
                yield name, gains[frozenset(named)] - instead


def test_no_group_holds_a_member_that_is_improbable_beside_the_named_one() -> None:
    """What its refits leave of held-out data allows it: it is more probable than chance beside the named effect."""
    seen = 0
    for row in (*rows(PERIODIC), *rows(FRESH)):
        for name, less in members(row):
            assert CRITERIA.evidence.learning_rate * less <= math.log(1 / CRITERIA.evidence.chance - 1), (
                row["seed"],
                name,
            )
            seen += 1
    assert seen > 50


def test_the_page_is_made_of_the_rows_that_are_kept() -> None:
    assert PAGE.read_text() == page(rows(OUT))

"""The rule by which an effect is added, and the order in which it is asked. Seeds stand in each test."""

from __future__ import annotations

from dataclasses import replace

from ident.diagnosis.evidence.blocks import BlockMean
from ident.diagnosis.evidence.comparison import SPANS
from ident.diagnosis.evidence.energy_bands import Record
from ident.diagnosis.evidence.rule import worth_adding
from tests.diagnosis.test_evidence import compared, periodic


def test_a_bar_is_asked_for_where_nothing_else_speaks_against_an_effect() -> None:
    """Of long records it takes as long as a refit, and what it is compared with is known at once."""
    before, after = periodic(30, 0.3, seed=13)
    found = compared([before], [after], [Record(1.0, period=87.3)])
    asked: list[float] = []

    def bar() -> float:
        asked.append(0.1 * found.most)
        return asked[-1]

    little = replace(found, gain=0.2 * found.most, without=0.2 * found.most)
    loses = {**found.parts, [*SPANS][-1]: BlockMean(-0.5 * found.explainable, 1e-9, 20)}
    assert not worth_adding(replace(little, by_part=lambda: loses), bar)
    assert not worth_adding(replace(little, gain=3.3, by_free_run=lambda: asked.append(1.0)), bar)  # type: ignore[arg-type, return-value]
    assert not asked
    assert worth_adding(little, bar)
    assert len(asked) == 1

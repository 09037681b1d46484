"""The rule by which an effect is added, and the order in which it is asked. Seeds stand in each test."""

from __future__ import annotations

import string
from dataclasses import replace
from typing import Any

import pytest

from ident.diagnosis.evidence import rule
from ident.diagnosis.evidence.energy_bands import Record
from ident.diagnosis.evidence.evidence import SPANS, BlockMean, Evidence
from ident.diagnosis.evidence.free_run import FreeRun
from tests.diagnosis.test_evidence import compared, periodic

NOTHING = BlockMean(0.0, 0.0, 20)


def evidence(**known: Any) -> Evidence:
    """The evidence for a model that takes nothing of a power of one, except for the fields that are stated."""
    usual: dict[str, Any] = {
        "gain": 0.0, "without": 50.0, "most": 1e3, "distinct": 50.0, "before": 1.0, "after": 1.0, "noise": 0.0,
        "difference": NOTHING, "share": NOTHING, "by_part": dict, "apart": 0.0, "resolved": 0.0,
    }  # fmt: skip
    return Evidence(**usual | known)


def taking(share: float, **known: Any) -> Evidence:
    """The evidence for a model that takes such a share of the power, without an error."""
    return evidence(share=BlockMean(share, 0.0, 20), difference=BlockMean(share, 0.0, 20), **known)


@pytest.mark.parametrize(("share", "is_enough"), [(0.0085, False), (0.0115, True)])
def test_a_hundredth_of_the_power_matters(share, is_enough):
    assert rule.matters(taking(share)) is is_enough


@pytest.mark.parametrize(("level", "is_enough"), [(2.5e-4, False), (3.5e-4, True)])
def test_means_of_three_in_ten_thousand_of_the_deviation_matter(level, is_enough):
    assert rule.matters(evidence(level=level, level_share=BlockMean(0.5, 0.0, 20))) is is_enough


@pytest.mark.parametrize(
    ("gain", "most", "bar", "improves"),
    [
        (2.9, 1e3, 0.0, False),
        (3.9, 1e3, 0.0, True),  # an effect has to gain 3.4 nats whatever the bar
        (43.0, 100.0, 1e3, False),
        (57.0, 100.0, 1e3, True),  # and half of the largest gain, or more than the bar
    ],
)
def test_a_gain_improves_that_is_worth_a_parameter_and_passes_the_bar_or_half_of_what_can_be_gained(
    gain, most, bar, improves
):
    found = taking(0.5, gain=gain, most=most) if gain < 50.0 else taking(0.5, gain=gain, without=gain, most=most)
    assert rule.improves_on_the_whole(found, lambda: bar) is improves


# The order of the questions, and their reasons


@pytest.mark.parametrize("question", [*rule.QUESTIONS, rule.refusing(taking(0.5), False)])
def test_a_reason_names_the_numbers_of_its_question_and_no_others(question):
    rising, falling = FreeRun(power=1.0, expected=0.1), FreeRun(power=0.5, expected=0.1)
    loses = dict.fromkeys(SPANS, BlockMean(-1.0, 0.0, 20))
    found = evidence(by_part=lambda: loses, by_free_run=lambda: (falling, rising))
    named = {name for _, name, _, _ in string.Formatter().parse(question.refusal) if name}
    assert named == {*question.numbers(found)}
    assert str(question.reason(found)).endswith(".")


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
    assert not rule.worth_adding(replace(little, by_part=lambda: loses), bar)
    assert not rule.worth_adding(replace(little, gain=3.3, by_free_run=lambda: asked.append(1.0)), bar)  # type: ignore[arg-type, return-value]
    assert not asked
    assert rule.worth_adding(little, bar)
    assert len(asked) == 1

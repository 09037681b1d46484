"""Each number by which a sample of a bench is divided decides a case that lies within a third of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.bench import model as models
from ident.bench.exact_response import PARTS, division
from ident.bench.model import Answer, Model
from ident.bench.records import Record
from ident.bench.reduced_record import Observed
from ident.bench.speed_table import SpeedTable

STILL, FULL = 0.002, 0.5


def parts(*currents: float, contact: int = 1, turns: bool = False) -> int:
    """Of a sample with these currents behind the play at its start, middle and end; the zero shift is none."""
    return PARTS[division(*currents, 0.0, contact, turns, STILL, FULL)[0]]


@pytest.mark.parametrize(
    ("currents", "contact", "turns", "divided"),
    [
        ((0.001, 0.001, 0.001), 0, False, 1),  # at rest
        ((0.1, 0.1001, 0.1002), 1, False, 2),  # moving
        ((0.1, 0.1001, 0.1001), 1, True, 8),  # the play turns
        ((0.001, 0.001, 0.001), 0, True, 8),  # and at rest
        ((0.49, 0.5, 0.51), 1, False, 32),  # all of the supply pressure is reached
        ((0.003, 0.0, -0.003), -1, False, 32),  # from one direction to the other
    ],
)
def test_a_sample_is_divided_by_how_the_play_moves_in_it(currents, contact, turns, divided):
    assert parts(*currents, contact=contact, turns=turns) == divided


@pytest.mark.parametrize(("share", "divided"), [(0.22, 2), (0.28, 32)])
def test_a_current_goes_far_from_a_quarter_of_itself_on(share, divided):
    assert parts(0.1, 0.1 * (1.0 + share), 0.1 * (1.0 + 2.0 * share)) == divided


def test_a_record_with_an_effect_is_simulated_in_four_parts_of_a_sample():
    asked: list[Any] = []

    def answer(current: np.ndarray, *given: Any) -> Answer:
        asked.append(given[-1])
        return Answer(current, current, current)

    record = Record("r", "static", 1e3, "linear", np.zeros(100), np.zeros(100), None, 0.0)
    model = SimpleNamespace(is_plain=False, answer=answer)
    Observed.of(record)._simulated(model, np.arange(9), 0.0, np.empty((1, 9)), np.empty((1, 0)))  # type: ignore[arg-type]
    assert asked == [4]


@pytest.mark.parametrize(("T", "divided"), [(1.0, 40), (0.01, 100)])
def test_a_step_is_no_longer_than_a_tenth_of_the_lag_and_four_hundred_a_second(monkeypatch, T, divided):
    """Of a sample that lasts a tenth of a second."""
    asked: list[int] = []
    monkeypatch.setattr(models, "respond", lambda _current, _step, steps, *_: asked.append(steps))
    Model(T, 0.01, 0.0, 1e8, 1e5, SpeedTable.straight(0.1)).answer(np.zeros(3), 10.0)
    assert asked == [divided]

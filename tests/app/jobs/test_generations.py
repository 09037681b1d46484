"""Each generation of a search is stored once, and a search that is taken up again is the same to the last bit."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from app.jobs.stored_state import added, whole
from ident.fit import genetic

State = dict[str, Any]
OPTIONS = {**genetic.DEFAULT, "population": 12.0, "generations": 6.0, "elite": 2.0}
STEPS = {"ga": genetic.default_step, "paper-ga": genetic.paper_step}


def errors(points: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(((points - 0.3) ** 2).sum(axis=1))


def searched(method: str) -> list[State]:
    """What each step of a search returned, two generations a step, whole."""
    state = genetic.begin(3, 0, {**OPTIONS, **genetic.PAPER, "population": 12.0, "survivors": 2.0})
    found = [{"outcome": None, "state": state}]
    while not state["done"]:
        for _ in range(2):
            if not state["done"]:
                state = STEPS[method](state, errors, {**genetic.PAPER, **OPTIONS, "keep": 0.8, "survivors": 2.0})
        found.append({"outcome": None, "state": state})
    return found


@pytest.mark.parametrize("method", STEPS)
def test_a_search_is_put_together_from_what_each_step_added(method: str) -> None:
    first, *steps = searched(method)
    now = first
    for step in steps:
        stored = json.loads(json.dumps(added(now["state"], step)))
        now = whole(now["state"], stored)
        assert now == step
    assert len(steps) > 2


@pytest.mark.parametrize("method", STEPS)
def test_each_generation_is_stored_once(method: str) -> None:
    first, *steps = searched(method)
    stored = [first] + [added(before["state"], step) for before, step in zip([first, *steps], steps, strict=False)]
    text = json.dumps(stored)
    for generation in steps[-1]["state"]["history"]:
        assert text.count(json.dumps(generation["population"])) == 1


def test_what_a_version_before_stored_is_whole_already() -> None:
    first, *steps = searched("ga")
    assert whole(first["state"], steps[-1]) == steps[-1]


@pytest.mark.parametrize("made", [{"outcome": "cancelled", "state": {}}, {"outcome": None, "state": {"done": True}}])
def test_what_is_no_search_stays_as_it_is(made: State) -> None:
    """How a job ended, and the steps of a diagnosis."""
    assert whole({"done": True}, added({"done": True}, made)) == made
    history = searched("ga")[-1]["state"]
    assert whole(history, added(history, made)) == made

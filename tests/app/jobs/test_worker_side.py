"""A search that is worked on elsewhere: its history is sent once, and what a lost process knew is sent again."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import pytest

from app.jobs import worker_side
from app.jobs.stored_state import unpacked, whole
from app.jobs.work import State, Task, Work
from app.storage import Storage
from app.tables import MatrixRow
from ident.progress import silent


class Growing(Work):
    """Adds two generations a block to its history, and ends after three blocks."""

    def __init__(self, task: Task) -> None:
        self.task = task

    def begin(self) -> State:
        return {"done": False, "history": [], "population": [0.0] * 100}

    def advance(self, state: State) -> State:
        history = list(state["history"])
        population = state["population"]
        for _ in range(2):
            history.append({"number": len(history), "population": population})
            population = [one + 1.0 for one in population]
        return {"done": len(history) >= 6, "history": history, "population": population}

    def finish(self, state: State) -> State:
        return {"count": len(state["history"]), "last": state["population"][0]}


@pytest.fixture
def task(tmp_path: Path) -> Task:
    return Task({}, None, MatrixRow(id="m"), Storage(tmp_path))


def searched(task: Task, turn: str, lost_after: int | None = None) -> tuple[Any, list[int]]:
    """What a search ends with as the queue has it done, and how many bytes each step was sent."""
    sent: list[int] = []

    def asked(name: worker_side.Step, state: State) -> State:
        given = worker_side.short(state)
        try:
            made: State = worker_side.step(turn, Growing, task, name, pickle.loads(pickle.dumps(given)), silent)
        except worker_side.Unheld:
            given = state
            made = worker_side.step(turn, Growing, task, name, pickle.loads(pickle.dumps(given)), silent)
        sent.append(len(pickle.dumps(given)))
        return pickle.loads(pickle.dumps(made))

    now = worker_side.step(turn, Growing, task, "begin", silent)
    steps = 0
    while not now["state"]["done"]:
        if steps == lost_after:
            worker_side.leave(turn)
        now = whole(now["state"], asked("advance", now["state"]))
        steps += 1
    result = asked("finish", now["state"])
    assert numbers_in(now) < 50  # nothing long is kept by who asks
    return (unpacked(now["state"]), result), sent


def numbers_in(value: Any) -> int:
    """How many numbers the interpreter keeps of it."""
    if isinstance(value, dict):
        value = list(value.values())
    return sum(map(numbers_in, value)) if isinstance(value, list) else isinstance(value, int | float)


def test_what_is_known_there_is_not_sent_again(task: Task) -> None:
    (state, result), sent = searched(task, "a")
    assert [entry["number"] for entry in state["history"]] == list(range(6))
    assert [entry["population"][0] for entry in state["history"]] == list(range(6))
    assert result == {"outcome": None, "state": {"count": 6, "last": 6.0}}
    assert max(sent) < 100


@pytest.mark.parametrize("lost_after", [0, 1, 2])
def test_a_process_that_was_lost_is_told_all_once(task: Task, lost_after: int) -> None:
    """And the search ends as if nothing had been."""
    undisturbed, _ = searched(task, "b")
    found, sent = searched(task, f"c{lost_after}", lost_after)
    assert found == undisturbed
    assert [size > 100 for size in sent] == [step == lost_after for step in range(4)]


def test_what_is_known_of_another_step_is_not_taken_for_it(task: Task) -> None:
    first = worker_side.step("d", Growing, task, "begin", silent)["state"]
    worker_side.step("d", Growing, task, "advance", worker_side.short(first), silent)
    with pytest.raises(worker_side.Unheld):
        worker_side.step("d", Growing, task, "advance", worker_side.short(first), silent)

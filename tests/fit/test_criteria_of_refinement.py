"""Each number of the refinement decides a case that lies within a third of it."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.fit.bounded_step import bounded_step
from ident.fit.fitness import means_of
from ident.fit.levenberg_marquardt import Way, levenberg_marquardt
from ident.fit.linear_fitness import LinearFitness
from ident.fit.normal_matrices import NormalMatrices

GAIN = 0.01
WIDE = (0.0, 1000.0)


def here(error: float, gain: float = GAIN) -> Any:
    """A point from which a step of length one promises a gain."""
    return SimpleNamespace(error=error, gradient=np.array([-2.0 * gain]), curvature=np.array([[2.0 * gain]]))


def steps_of(found: Callable[[float], Any], way: Way | None = None) -> tuple[list[float], int]:
    """The places at which an objective on a line is asked for its value, from 0 on, and the number of rounds."""
    tried: list[float] = []
    rounds: list[int] = []

    def evaluate(point: np.ndarray) -> Any:
        tried.append(float(point[0]))
        return found(tried[-1])

    levenberg_marquardt(evaluate, np.zeros(1), way or Way(within=WIDE), lambda count, _: rounds.append(count))
    return tried, len(rounds)


def then_nothing_helps(kept: float) -> Callable[[float], Any]:
    """An objective on which the first step keeps so much of its promise, and no other helps."""
    return lambda x: here(1.0) if x == 0 else here(1.0 - kept * GAIN) if 0.999 < x < 1.001 else here(2.0)


def kept_for(damping: float) -> float:
    """What of its promise a first step has to keep for its damping to be multiplied so (Nielsen 1999)."""
    return 0.5 * (1.0 + float(np.cbrt(1.0 - damping)))


def test_a_refinement_ends_after_200_steps():
    tried, _ = steps_of(lambda x: here(1.0 - 0.001 * x, 0.001))
    assert tried[-1] == pytest.approx(200.0, rel=0.01)


@pytest.mark.parametrize(("promised", "steps"), [(0.85e-10, 0), (1.15e-10, 1)])
def test_a_refinement_ends_where_a_step_promises_next_to_nothing(promised, steps):
    tried, _ = steps_of(lambda _: here(1.0, promised), Way(most=1, within=WIDE))
    assert len(tried) == 1 + steps


def test_the_first_step_is_damped_by_a_ten_thousandth():
    tried, _ = steps_of(lambda x: here(1.0 - GAIN * x), Way(most=1, within=WIDE))
    assert 1.0 / tried[1] - 1.0 == pytest.approx(1e-4, rel=0.15)


@pytest.mark.parametrize(("damping", "rounds"), [(0.85e6, 11), (1.15e6, 10)])
def test_a_step_that_fails_is_the_last_from_a_damping_of_a_million_on(damping, rounds):
    """After eight steps that fail it is 2 to the 36th of what it was."""
    _, count = steps_of(then_nothing_helps(kept_for(damping / (1e-4 * 2.0**36))))
    assert count == rounds


def test_the_damping_falls_tenfold_at_most():
    tried, _ = steps_of(lambda x: here(1.0 - GAIN * x), Way(most=2, within=WIDE))
    assert 1.0 / (tried[2] - tried[1]) - 1.0 == pytest.approx(1e-5, rel=0.15)


@pytest.mark.parametrize(("steps", "lost"), [(3.4, False), (4.6, True)])
def test_who_is_four_steps_from_an_aim_gives_up(steps, lost):
    assert Way(aim=1.0).is_lost(1.0 + steps * GAIN, 0.5 * GAIN, GAIN) is lost


@pytest.mark.parametrize(("missed", "goes_on"), [(0.085, False), (0.115, True)])
def test_a_promise_is_believed_where_the_last_was_kept_within_a_tenth(missed, goes_on):
    """The next step promises a thousandth of what is missing."""
    tried, _ = steps_of(
        lambda x: here(1.0) if x == 0 else here(1.0 - (1.0 - missed) * GAIN, 1e-3 * GAIN),
        Way(within=WIDE, aim=1.0 - 100 * GAIN),
    )
    assert (len(tried) > 2) is goes_on


@pytest.mark.parametrize(("nearer", "tried_again"), [(0.085, False), (0.115, True)])
def test_a_step_within_a_tenth_of_one_that_failed_is_not_tried(nearer, tried_again):
    """After four steps that fail the damping is 1024 times what it was; it shortens the step by so much."""
    damping = nearer / (1.0 - nearer)
    tried, _ = steps_of(then_nothing_helps(kept_for(damping / (1e-4 * 2.0**10))))
    assert (tried[3] - tried[1] == pytest.approx(1.0 - nearer, rel=0.01)) is tried_again


def test_sensitivities_are_differences_over_a_hundred_thousandth_of_an_axis():
    """Inwards where an axis ends."""
    asked: list[np.ndarray] = []

    class Asked(Exception):
        """The points are known."""

    def values(points: np.ndarray) -> dict[str, np.ndarray]:
        asked.append(points)
        raise Asked

    fitness = LinearFitness(None, None, (), SimpleNamespace(values=values), None)
    with pytest.raises(Asked):
        fitness.exact(np.array([0.5, 1.0]))
    assert asked[0] - asked[0][0] == pytest.approx(np.array([[0, 0], [1e-5, 0], [0, -1e-5]]), rel=0.15)


@pytest.mark.parametrize(("share", "moves"), [(0.85e-7, False), (1.15e-7, True)])
def test_a_newton_step_leaves_out_directions_of_a_ten_millionth(share, moves):
    H = np.array([[1.0, 1.0 - 2.0 * share], [1.0 - 2.0 * share, 1.0]])
    step = bounded_step(np.full(2, 0.5), H, 0.1 * 2.0 * share * np.array([1.0, -1.0]))
    assert step == pytest.approx([-0.1, 0.1] if moves else [0.0, 0.0], abs=1e-3)


def exactly(count: int) -> list[NormalMatrices]:
    """Runs of 100 samples without a residual, whose means meet."""
    gram = np.zeros((2, 2))
    return [NormalMatrices(gram, np.zeros((1, 1)), 2.0, 0.0, means=np.zeros(2), length=100) for _ in range(count)]


@pytest.mark.parametrize(("runs", "tell"), [(2, False), (3, True)])
def test_the_means_of_three_runs_tell_of_a_bias(runs, tell):
    assert (means_of(exactly(runs), 0.1) is not None) is tell


def test_means_that_meet_exactly_are_known_to_rounding():
    found = means_of(exactly(3), 0.1)
    assert found is not None
    assert found.gram[-1, -1] == pytest.approx(1e-14 * 2.0 / 100, rel=0.15, abs=0.0)

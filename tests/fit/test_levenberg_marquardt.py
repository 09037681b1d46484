"""A search that goes to the optimum near its start, or gives up where that is of no use."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray

from ident.fit.levenberg_marquardt import Way, levenberg_marquardt

Array = NDArray[np.float64]
START, END, LEAST = np.array([0.1, 0.9]), np.array([0.6, 0.5]), 1.0  # what is left at the end


@dataclass
class Flat:
    """Squares of squares about a point, and what is left there: each step halves the way."""

    evaluations: int = 0

    def __call__(self, point: Array) -> Here:
        """The objective at a point."""
        self.evaluations += 1
        away = point - END
        residual, slope = 10.0 * away**2, np.diag(20.0 * away)
        return Here(LEAST + 0.5 * float(residual @ residual), slope.T @ residual, slope.T @ slope)


@dataclass(frozen=True)
class Here:
    """Error, gradient and curvature."""

    error: float
    gradient: Array
    curvature: Array


def test_what_has_to_come_below_an_error_that_it_reaches_goes_all_the_way():
    plain, asked = Flat(), Flat()
    point, here = levenberg_marquardt(plain, START)
    same, there = levenberg_marquardt(asked, START, Way(aim=1.05 * LEAST))
    assert point == pytest.approx(END, abs=1e-2)
    assert np.array_equal(same, point)
    assert there.error == here.error == pytest.approx(LEAST)


def test_what_cannot_come_below_an_error_is_given_up_on_the_way():
    plain, asked = Flat(), Flat()
    _, best = levenberg_marquardt(plain, START)
    _, here = levenberg_marquardt(asked, START, Way(aim=0.1 * LEAST))
    assert asked.evaluations < plain.evaluations
    assert here.error >= best.error


def test_from_its_end_nothing_leads_to_an_error_far_below_it():
    """From its start, and to an error that it comes near, something does."""
    end, here = levenberg_marquardt(Flat(), START)
    assert Way(aim=0.1 * LEAST).leads_nowhere(end, here)
    assert not Way(aim=1.05 * LEAST).leads_nowhere(end, here)
    assert not Way(aim=0.9 * LEAST).leads_nowhere(START, Flat()(START))
    assert not Way().leads_nowhere(end, here)


@dataclass
class Straight:
    """Squares of two residuals that are nearly straight in the point: a step leads 95 % of the way."""

    evaluations: int = 0

    def __call__(self, point: Array) -> Here:
        """The objective at a point."""
        self.evaluations += 1
        away = np.array([3.0, 1.0]) * (point - END)
        return Here(LEAST + 0.5 * float(away @ away), np.array([3.0, 1.0]) * away, 1.05 * np.diag([9.0, 1.0]))


def test_where_steps_keep_their_promise_the_next_one_is_believed():
    """After one step next to nothing is promised; where the valley bends a second one has to say so, too."""
    straight, bent = Straight(), Flat()
    levenberg_marquardt(straight, START, Way(aim=0.9 * LEAST))
    levenberg_marquardt(bent, START, Way(aim=0.9 * LEAST))
    assert straight.evaluations == 2
    assert bent.evaluations == 3


def test_what_has_come_far_enough_goes_no_further():
    plain, asked = Flat(), Flat()
    levenberg_marquardt(plain, START)
    _, here = levenberg_marquardt(asked, START, Way(enough=1.5 * LEAST))
    assert asked.evaluations < plain.evaluations
    assert here.error <= 1.5 * LEAST


def banana(point: Array) -> Here:
    """A narrow valley that bends (Rosenbrock), as far below what is left as that of a machine's undetermined lags."""
    x, y = 4.0 * point - 2.0
    residual = np.array([300.0 * (y - x**2), 1.0 - x])
    slope = 4.0 * np.array([[-600.0 * x, 300.0], [-1.0, 0.0]])
    return Here(LEAST + 0.5 * float(residual @ residual), slope.T @ residual, slope.T @ slope)


def test_a_valley_that_bends_is_followed_to_its_end():
    """By a fixed factor every other step was too long, and 200 led a tenth of the way."""
    point, here = levenberg_marquardt(banana, np.array([0.2, 0.75]))
    assert 4.0 * point - 2.0 == pytest.approx([1.0, 1.0], abs=1e-3)
    assert here.error == pytest.approx(LEAST, rel=1e-6)


@dataclass
class Kinked:
    """Squares about zero, of an axis, and above them a step up beyond half of the way that the slope at 1 promises."""

    tried: list[float]

    def __call__(self, point: Array) -> Here:
        """The objective at a point, which is kept."""
        x = float(point[0])
        self.tried.append(x)
        return Here(LEAST + 0.5 * x**2 + (1.0 if x < 0.5 else 0.0), np.array([x]), np.eye(1))


def test_a_step_next_to_one_that_failed_is_not_tried():
    """A little damping hardly shortens it: what differs enough is tried, and helps."""
    kinked = Kinked([])
    _, here = levenberg_marquardt(kinked, np.array([1.0]), Way(most=6))
    _, whole, shorter = kinked.tried
    assert whole == pytest.approx(0.0, abs=1e-3)
    assert 0.5 < shorter < 0.9
    assert here.error == LEAST + 0.5 * shorter**2

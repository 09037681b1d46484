"""Steps along a logarithmic axis that are straight in its parameter."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray

from ident.fit.levenberg_marquardt import Way, levenberg_marquardt
from ident.fit.straight_steps import led

Array = NDArray[np.float64]
LOWER, UPPER = np.array([1e-3, 1e-6]), np.array([1e6, 1e6])  # of a stiffness and a mass
SPANS = np.log(UPPER / LOWER)
TRUE = np.array([35.0, 16.0])
PHASE = np.linspace(0.0, 20.0, 200)
COLUMNS = np.column_stack([np.sin(PHASE) + 0.02 * np.sin(3 * PHASE), -np.sin(PHASE)])  # x and its second rate


@dataclass(frozen=True)
class Here:
    """Error, gradient and curvature."""

    error: float
    gradient: Array
    curvature: Array


def of_force(point: Array) -> Here:
    """Squares of k x + m a less those of the truth, by k and m on logarithmic axes: next to one valley k − m."""
    values = LOWER * np.exp(SPANS * point)
    residual, slope = COLUMNS @ (TRUE - values), COLUMNS * SPANS * values
    return Here(1.0 + float(residual @ residual), -2 * slope.T @ residual, 2 * slope.T @ slope)


def along(value: float, axis: int) -> float:
    return float(np.log(value / LOWER[axis]) / SPANS[axis])


@pytest.mark.parametrize("mass", [1e-6, 1e-2, 1e3])
def test_what_is_linear_in_its_parameters_is_found_in_a_few_steps_from_anywhere(mass):
    """Straight in the logarithm the steps crept along a bent valley, and a mass at its lower bound stayed there."""
    evaluations = []

    def counted(point: Array) -> Here:
        evaluations.append(point)
        return of_force(point)

    start = np.array([along(20.0, 0), along(mass, 1)])
    point, here = levenberg_marquardt(counted, start, spans=SPANS)
    assert LOWER * np.exp(SPANS * point) == pytest.approx(TRUE, rel=1e-4)
    assert len(evaluations) < 12
    _, bent = levenberg_marquardt(of_force, start, Way(most=len(evaluations)))
    assert bent.error > 1.001 * here.error


def test_a_step_grows_the_parameter_by_its_slope():
    point, step = np.array([0.3, 0.6]), np.array([0.04, -1e-3])
    within, end = led(point, step, 0.0, 1.0, SPANS)
    assert np.array_equal(within, step)
    assert np.exp(SPANS * (end - point)) == pytest.approx(1.0 + SPANS * step)


def test_on_a_linear_axis_a_step_is_itself():
    for step, end in ((0.2, 0.5), (-0.5, 0.0), (0.9, 1.0)):
        within, there = led(np.array([0.3]), np.array([step]), 0.0, 1.0, np.zeros(1))
        assert there == pytest.approx([end])
        assert within == pytest.approx([end - 0.3])


@pytest.mark.parametrize("point", [[0.3, 1.0], [0.0, 0.5], [1.0, 0.0]])
@pytest.mark.parametrize("spans", [SPANS, np.array([2000.0, 0.0])])
def test_a_step_beyond_a_bound_ends_at_it(point, spans):
    """From within and from a bound, over decades beyond what a number holds."""
    for far, bound in ((-1e300, 0.0), (1e300, 1.0)):
        within, end = led(np.array(point), np.full(2, far), 0.0, 1.0, spans)
        assert end.tolist() == [bound, bound]
        assert np.all(np.isfinite(within))

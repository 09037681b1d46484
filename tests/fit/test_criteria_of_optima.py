"""Each number about optima, bounds and bad runs decides a case that lies within a third of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.fit.far_bounds import far_from
from ident.fit.local_optima import LocalOptimum, agreeing, at_bound, competing_optima, equivalent_points
from ident.fit.modes import FOLLOWED
from ident.fit.multistart import _all_ends, bad_runs, multistart
from ident.fit.settings import Settings
from ident.fit.space import Axis, Space, search_space
from ident.fit.wider_bounds import reaching
from ident.matrix import Actuator, Matrix
from ident.presets import PRESETS
from ident.run import Run, Specimen
from ident.simulation.steps import MOST

QIAN = PRESETS["qian2014"]


def end(error: float) -> LocalOptimum:
    """An end with this error."""
    return LocalOptimum(error, {}, np.full(1, 0.5))


def test_ends_are_one_valley_agree_or_compete_by_their_errors():
    """A millionth, a thousandth and a hundredth of the error."""
    ends = [end(1.0 + 1e-6 * off) for off in (0.0, 0.85, 1.15, 850.0, 1150.0, 8500.0, 11500.0)]
    assert (len(equivalent_points(ends)), agreeing(ends, ends[0]), len(competing_optima(ends))) == (2, 4, 4)


class Objective:
    """A fitness of which a start ends with the error that it is: a point of one axis."""

    def __init__(self) -> None:
        self.runs, self.evaluations, self.space = (), 0, SimpleNamespace(names=(), values=lambda _: {})

    def fresh(self, _: Any) -> Objective:
        """The same."""
        return self

    def optimum(self, start: np.ndarray, **_: Any) -> tuple[np.ndarray, Any]:
        """The start itself."""
        return start, SimpleNamespace(error=float(start[0]), runs=())


def starts(*errors: float) -> list[np.ndarray]:
    """Those that end with these errors."""
    return [np.array([1e-3 * error]) for error in errors]


def test_three_further_starts_that_agree_settle_it():
    found = list(_all_ends(Objective(), starts(2.0, 3.0), starts(*[1.0] * 9), lambda _: None, 0))
    assert len(found) == 2 + 3


def test_two_competing_ends_are_followed_to_the_last_sample():
    objective = Objective()
    found = multistart(objective, objective, starts(1.0, 1.001, 1.002, 1.003, 1.004), lambda _: None)
    assert len(found.ends) == 1 + 2


@pytest.mark.parametrize(("place", "is_at"), [(0.85e-6, True), (1.15e-6, False)])
def test_a_value_is_at_its_bound_within_a_millionth_of_the_axis(place, is_at):
    space = Space((Axis("m0", 1.0, 2.0, logarithmic=False),), ("m0",), {}, {})
    for point in (np.array([place]), np.array([1.0 - place])):
        assert space.at_bound("m0", point) is is_at
        assert at_bound(LocalOptimum(1.0, {}, point)) is is_at


def bad(errors: list[float]) -> int:
    """How many runs with these errors are bad."""
    runs = [SimpleNamespace(id=str(i)) for i in range(len(errors))]
    return len(bad_runs(runs, SimpleNamespace(runs=[SimpleNamespace(error=one) for one in errors])))


@pytest.mark.parametrize(("runs", "found"), [(4, 0), (5, 1)])
def test_a_run_is_bad_that_stands_out_of_five_and_more(runs, found):
    assert bad([0.1] * (runs - 1) + [0.4]) == found


@pytest.mark.parametrize(
    ("spread", "log", "found"), [(0.01, np.log(2.6), 0), (0.01, np.log(3.4), 1), (0.3, 1.9, 0), (0.3, 2.55, 1)]
)
def test_a_run_is_bad_beyond_five_deviations_and_three_times_the_usual_error(spread, log, found):
    """Half of the logarithms of the errors lie within the spread, which is so 1 / 1.4826 deviations."""
    usual = [-spread] * 3 + [0.0] * 3 + [spread] * 3
    assert bad(np.exp([*usual, log]).tolist()) == found


@pytest.mark.parametrize(("standing_out", "found"), [(5, 5), (6, 0)])
def test_one_run_in_twenty_is_bad_at_most(standing_out, found):
    assert bad([0.1] * (100 - standing_out) + [0.5] * standing_out) == found


@pytest.mark.parametrize(("value", "upper"), [(9.0, 10.0), (11.0, 100.0), (1e6, 1000.0)])
def test_a_range_that_was_too_narrow_reaches_ten_times_as_far_up_to_three_times(value, upper):
    space = Space((Axis("m0", 0.1, 1.0, logarithmic=True),), ("m0",), {}, {})
    assert reaching(space, {"m0": value}, ["m0"]).axes[0].upper == pytest.approx(upper)


@pytest.mark.parametrize(("times", "is_far"), [(26.0, False), (34.0, True), (1 / 26, False), (1 / 34, True)])
def test_a_value_thirty_times_off_is_far_off(times, is_far):
    found = far_from(Settings(fixed={"m0": 50.0 * times}), QIAN, {"m0": (50.0, 50.0)})
    assert bool(list(found)) is is_far


def matrix(command: np.ndarray, area: float = 1e-3) -> Matrix:
    """A run of a machine of which everything is stated."""
    moved = np.random.default_rng(0).standard_normal(len(command))
    channels = {"command": command, "displacement": moved}
    run = Run("r", "", 1000.0, channels, dict.fromkeys(channels, "m"), gain=5.0, specimen=Specimen(10.0))
    return Matrix(Actuator("A", piston_area=area), (run,))


def test_the_band_of_steps_is_a_tenth_of_where_their_power_reaches():
    typical = search_space(QIAN, matrix(np.ones(500)), Settings(), 100.0).typical
    assert typical["W"] == pytest.approx(100.0 / 10.0)


@pytest.mark.parametrize(("off", "same"), [(0.017, True), (0.023, False)])
def test_a_paper_s_bounds_hold_for_a_piston_area_within_two_per_cent(off, same):
    assert QIAN.search.bounds_hold_for is not None
    of = matrix(np.sin(np.arange(500.0)), QIAN.search.bounds_hold_for * (1.0 + off))
    assert search_space(QIAN, of, Settings(), 100.0).scale_free is not same


def test_a_mode_is_followed_up_to_two_and_a_half_times_the_accurate_ones():
    """A Runge-Kutta step of it is stable, one of a sixth more is not: 1 + z + z²/2 + z³/6 + z⁴/24 (Hairer 1993)."""
    z = -FOLLOWED / MOST * np.array([1.0, 1.15])
    grows = np.abs(1.0 + z + z**2 / 2.0 + z**3 / 6.0 + z**4 / 24.0)
    assert grows[0] < 0.8
    assert grows[1] > 1.0

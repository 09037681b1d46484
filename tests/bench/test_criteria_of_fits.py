"""Each number of the fits of a bench decides a case that lies within a third of it."""

from __future__ import annotations

from inspect import signature
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.bench import analysis, identification, polish, scatter
from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.least_squares import solve
from ident.bench.model import Model
from ident.bench.records import Record
from ident.bench.reduced_record import Observed
from ident.bench.residual import Residual
from ident.bench.speed_table import SpeedTable


def objective(gain: float, falls: bool = True) -> Any:
    """A residual on a line: each step of length one promises a gain, and keeps it where it falls."""
    asked: list[float] = []

    def normal(point: np.ndarray) -> Any:
        asked.append(float(point[0]))
        error = 1.0 - gain * asked[-1] if falls or not asked[-1] else 2.0
        return SimpleNamespace(error=error, gradient=np.array([-2.0 * gain]), curvature=np.array([[2.0 * gain]]))

    within = (np.zeros(1), np.full(1, np.inf))
    return SimpleNamespace(origin=np.zeros(1), normal=normal, is_exact=True, within=within, asked=asked)


def test_a_fit_of_a_bench_ends_after_its_steps():
    """Twelve; each no longer than 0.7. One of all values has eight."""
    assert solve(objective(0.01)).point[0] == pytest.approx(0.7 * 12)
    of = signature(analysis.fit_whole).parameters["steps"].default
    assert solve(objective(0.01), steps=of).point[0] == pytest.approx(0.7 * 8)


@pytest.mark.parametrize(
    ("effort", "converged", "rough"), [("rough", 1e-5, 1e-4), ("but_one", 1e-6, 1e-6), ("last", 1e-10, 1e-7)]
)
@pytest.mark.parametrize("share", [0.85, 1.15])
def test_a_fit_of_a_bench_ends_where_its_effort_ends(effort, converged, rough, share):
    """Where a step promises next to nothing, and where one failed that promised less than the error is smooth.

    No step is longer than 0.7.
    """
    way = getattr(BENCH_CRITERIA.fits, effort)
    assert solve(objective(0.01), steps=1, way=way).point[0] == pytest.approx(0.7)
    promised = 1.0 - (1.0 - 0.7) ** 2  # of a gain, by a step of 0.7
    assert (solve(objective(share * converged / promised), steps=1, way=way).point[0] > 0) == (share > 1)
    if rough == converged:  # no step that is tried promises less
        return
    failing = objective(share * rough / promised, falls=False)
    solve(failing, steps=9, way=way)
    assert (len(failing.asked) > 2) == (share > 1)


def polished(monkeypatch: pytest.MonkeyPatch, *costs: float) -> tuple[Any, list[str], list[int]]:
    """The best end and what is said, of the procedures' model and others that end at these sums of squares."""
    asked: list[int] = []

    def ended(start: float, steps: int) -> Any:
        asked.append(steps)
        return SimpleNamespace(
            cost=start, deviations={"T": 0.1}, values={"T": 1.0}, point=np.zeros(1), residual=SimpleNamespace(reach={})
        )

    monkeypatch.setattr(polish, "Residual", lambda start, *_: start)
    monkeypatch.setattr(polish, "solve", ended)
    best, said = polish.polished(costs[1:], costs[0], (), ("T",))  # type: ignore[arg-type]
    return best, said, asked


def test_what_a_search_found_is_refined_in_sixty_steps(monkeypatch):
    assert polished(monkeypatch, 1.0, 1.0)[2] == [60, 60]


@pytest.mark.parametrize(("apart", "one"), [(0.85e-4, True), (1.15e-4, False)])
def test_ends_in_folds_of_one_optimum_are_one(monkeypatch, apart, one):
    """Then the first of them is the best."""
    best, _, _ = polished(monkeypatch, 1.0 + apart, 1.0)
    assert (best.cost > 1.0) is one


@pytest.mark.parametrize(("farther", "astray"), [(1.0085, False), (1.0115, True)])
def test_a_search_that_ends_a_hundredth_farther_went_astray(monkeypatch, farther, astray):
    _, said, _ = polished(monkeypatch, 1.0, farther**2)
    assert (bool(said) and said[0].startswith("No member")) is astray


def residual(*names: str) -> Residual:
    """Of a model on a record that goes 0.1 m."""
    record = Record("r", "static", 1e3, "linear", np.zeros(500), np.linspace(0.0, 0.1, 500), None, 0.0)
    return Residual(Model(0.01, 0.01, 0.0, 1e8, 1e5, SpeedTable.straight(0.1)), (Observed.of(record),), names)


def test_a_value_that_may_be_zero_is_measured_by_a_twentieth_of_its_range():
    """The zero shift lies within a tenth of the rated current to either side; an effect is measured by the machine."""
    reach = residual("I0").reach
    assert reach["I0"] == pytest.approx(0.01)
    assert reach["second_lag__time_constant"] == pytest.approx(0.01)
    assert reach["stiction__pressure"] == pytest.approx(1e5)
    assert reach["spring_load__rate"] == pytest.approx(1e5 / 0.05, rel=0.01)


def test_a_value_goes_no_farther_than_150_times():
    of = residual("T")
    assert of.values(np.array([[9.0], [-9.0]]))["T"] / 0.01 == pytest.approx([np.exp(5.0), np.exp(-5.0)])


def test_what_acts_in_jumps_is_moved_by_the_stride_of_its_effect():
    """Stiction by 2e-3 of its range, 10 kPa; a lag as any axis."""
    of = residual("stiction__pressure", "second_lag__time_constant")
    assert of._strides * [of.reach[name] for name in of.names] == pytest.approx([1e4, 1e-5 * 0.01])


def test_a_way_begins_at_sixteen_places_within_a_step(monkeypatch):
    asked: list[int] = []

    def scores(*given: Any) -> np.ndarray:
        asked.append(given[-1])
        return np.zeros((given[-1], 1))

    monkeypatch.setattr(scatter, "at_places", scores)
    told = SimpleNamespace(known=np.ones(9), deviations=np.ones(9), step=1e-5, extra=0.0)
    observed = SimpleNamespace(readings=told, within=np.arange(9), parts=[(0, 9)])
    of = SimpleNamespace(ways=lambda *_: (np.zeros(9), np.ones((1, 9))))
    scatter._positions(of, np.zeros(1), observed, np.ones((1, 9)), np.ones(9))  # type: ignore[arg-type]
    assert asked == [16]


@pytest.mark.parametrize(("frequency", "rate"), [(None, 60.0), (5.0, 200.0)])
def test_a_search_takes_sixty_hertz_and_forty_samples_of_a_period(frequency, rate):
    assert identification.searched_rate(SimpleNamespace(frequency=frequency)) == rate  # type: ignore[arg-type]


def test_three_vectors_of_a_search_are_refined(monkeypatch):
    """In addition to what the procedures found."""
    asked: list[int] = []

    def known(starts: Any, *_: Any) -> Any:
        asked.append(len(starts))
        return None, []

    monkeypatch.setattr(identification, "polished", known)
    own = SimpleNamespace(values=dict)
    work = SimpleNamespace(
        _model=lambda point: point,
        analysis=SimpleNamespace(model=own),
        _own=lambda of: (of, ()),
        space=SimpleNamespace(bounds=lambda _: {}, names=()),
    )
    population = [[0.1 * place] for place in range(0, 10, 2)]
    identification.BenchIdentification._polished(work, {"best": [0.9], "population": population})  # type: ignore[arg-type]
    assert asked == [3]

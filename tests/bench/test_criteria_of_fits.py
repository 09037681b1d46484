"""Each number of the fits of a bench decides a case that lies within a third of it."""

from __future__ import annotations

from inspect import signature
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.bench import analysis, polish
from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.least_squares import solve


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
    """Where a step promises next to nothing, and where one failed that promised less than the error is smooth."""
    way = getattr(BENCH_CRITERIA.fits, effort)
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
        return SimpleNamespace(cost=start, deviations={"T": 0.1}, values={"T": 1.0}, point=np.zeros(1),
                               residual=SimpleNamespace(reach={}))  # fmt: skip

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

"""Where the polish of a search's best members ends, and a sentence where another end is nearly as good."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from ident.fit.fitness import Local, Steps
from ident.fit.levenberg_marquardt import levenberg_marquardt
from ident.fit.local_optima import LocalOptimum, competing_optima, disagreements, distinct, equivalent_points
from ident.fit.multistart import multistart
from ident.fit.result import Starts
from ident.fit.space import Axis, Space
from ident.progress import silent

LABEL = {"a": "a", "b": "b/A^2"}


@dataclass
class Wells:
    """A fitness of one parameter with two wells at `places`; `depths` are their errors, as searched and exactly."""

    depths: tuple[float, float]
    searched: tuple[float, float]
    space: Space = field(default_factory=lambda: Space((Axis("a", 0.0, 1.0, False),), ("a",), {}, {}))
    runs: tuple[()] = ()
    evaluations: int = 0
    places: tuple[float, float] = (0.2, 0.8)

    def _at(self, point: np.ndarray, depths: tuple[float, float]) -> Local:
        place, depth = list(zip(self.places, depths, strict=True))[int(point[0] >= 0.5)]
        off = point - place
        self.evaluations += 1
        return Local(depth + 50 * float(off @ off), 100 * off, 100 * np.eye(1), ())

    def optimum(self, start: np.ndarray, report: Steps, roughly: bool = False) -> tuple[np.ndarray, Local]:
        depths = self.searched if roughly else self.depths
        return levenberg_marquardt(lambda point: self._at(point, depths), start, report=report)

    def fresh(self, runs: tuple[()]) -> Wells:
        return replace(self, runs=runs, evaluations=0)


def found(depths: tuple[float, float], searched: tuple[float, float]):
    fitness = Wells(depths, searched)
    return multistart(fitness, fitness, [np.array([0.3]), np.array([0.7])], silent)


def tried_from(*starts: float, depths: tuple[float, float] = (1.0, 0.4)):
    """Polished from these and, where they do not settle it, from both wells in turn."""
    fitness = Wells(depths, depths)
    further = [np.array([place]) for place in (0.1, 0.9, 0.3, 0.7, 0.15, 0.95, 0.25, 0.75)]
    return multistart(fitness, fitness, [np.array([start]) for start in starts], silent, further)


def test_starts_that_disagree_are_begun_again_until_three_agree_with_the_best():
    optimum = tried_from(0.3, 0.7)
    assert optimum.starts == Starts(tried=8, agree=4)  # the sixth of the further ones is the third in the lower well
    assert optimum.point == pytest.approx([0.8])


def test_starts_that_agree_within_the_bounds_are_enough():
    assert tried_from(0.1, 0.3).starts == Starts(tried=2, agree=2)


def test_an_optimum_at_a_bound_is_begun_again():
    """The first well lies at the bound; every start of the search ended there."""
    fitness = Wells((1.0, 0.4), (1.0, 0.4), places=(0.0, 0.8))
    optimum = multistart(fitness, fitness, [np.array([0.1])], silent, [np.array([0.7])])
    assert optimum.starts == Starts(tried=2, agree=1)
    assert optimum.point == pytest.approx([0.8])


def said(ends, deviation: float = 0.1) -> list[str]:
    return list(disagreements(ends, {"a": deviation}, LABEL))


def test_two_optima_of_nearly_one_error_are_told():
    """Six standard errors apart, with 0.4 % more error: which parameter, and how far."""
    ends = found((1.0, 1.004), (1.0, 1.004)).ends
    assert [end.values["a"] for end in ends] == pytest.approx([0.2, 0.8])
    assert said(ends) == [
        "Other members of the search end elsewhere with an error at most 0.4 % larger; in standard errors they differ "
        "from this fit: a by 6."
    ]


def test_optima_that_are_worse_or_within_a_standard_error_are_not_told():
    assert said(found((1.0, 1.02), (1.0, 1.02)).ends) == []
    assert said(found((1.0, 1.004), (1.0, 1.004)).ends, deviation=0.7) == []


def test_optima_that_every_sample_tells_apart_are_not_told():
    """In the search they are nearly as good; followed to the last sample, one is not."""
    ends = found((1.0, 1.3), (1.0, 1.004)).ends
    assert len(ends) == 2
    assert said(ends) == []


def test_what_is_better_on_every_sample_is_the_fit():
    """The search preferred the other end by less than 1 %."""
    fit = found((1.0, 0.9), (1.0, 1.004))
    assert fit.point == pytest.approx([0.8])
    assert fit.here.error == pytest.approx(0.9)


def test_ends_of_one_error_are_a_valley_and_no_rivals():
    """They widen the standard errors instead."""
    ends = [
        LocalOptimum(error, {}, np.array([place])) for error, place in ((1.0, 0.1), (1.0 + 1e-8, 0.9), (1.001, 0.5))
    ]
    assert np.array(equivalent_points(ends)) == pytest.approx(np.array([[0.1], [0.9]]))
    assert competing_optima(ends) == ends[2:]


def test_every_parameter_that_differs_is_named_the_farthest_first():
    """By the name under which it is reported; what is not determined has no standard error to count in."""
    ends = [
        LocalOptimum(1.0, {"a": 1.0, "b": 5.0, "c": 0.0}, np.zeros(1)),
        LocalOptimum(1.002, {"a": 3.0, "b": 6.0, "c": 9.0}, np.ones(1)),
    ]
    (text,) = disagreements(ends, {"a": 1.0, "b": 0.1}, LABEL)
    assert text.endswith("differ from this fit: b/A^2 by 10, a by 2.")


def test_starts_are_distinct():
    """A tenth of an axis apart, the best first."""
    points = np.array([[0.5, 0.5], [0.55, 0.5], [0.5, 0.7], [0.9, 0.9]])
    assert np.array(distinct(points, 2)) == pytest.approx(points[[0, 2]])


def test_every_start_that_was_asked_for_is_tried_and_its_end_kept():
    """Also where the first two agree; the least error comes first, with the parameters found there."""
    fitness = Wells((1.0, 0.4), (1.0, 0.4))
    further = [np.array([place]) for place in (0.1, 0.9, 0.3, 0.7)]
    first = [np.array([0.6]), np.array([0.7])]
    starts = multistart(fitness, fitness, first, silent, further, count=5).starts
    assert (starts.tried, len(starts.errors)) == (5, 5)
    np.testing.assert_allclose(starts.errors, [0.4, 0.4, 0.4, 1.0, 1.0], rtol=1e-6)
    np.testing.assert_allclose(starts.values["a"], [0.8, 0.8, 0.8, 0.2, 0.2], rtol=1e-6)

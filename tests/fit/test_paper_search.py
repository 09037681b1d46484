"""The paper's genetic search gives its Figs. 13 and 14; the letter of its text does not (Qian et al. 2014, 2.2, 4.1).

The runs are those of the independent reference: seven specimens, three gains, the amplitudes alike.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest
from numpy.typing import NDArray

from ident.fit.identification import Identification
from ident.fit.settings import Settings
from tests.acceptance.test_identification import as_matrix, records_of

SEEDS = range(8)
GENERATIONS = 20  # of Fig. 14
SHOWN = (1, 4, 8, 12)  # of Fig. 13
FIRST, LAST = 23.0, 7.0  # of the cost in Fig. 14, first and last, as read off it
WORSE = 0.2  # of the first cost, by which chance may raise it from one generation to the next


@dataclass(frozen=True)
class Course:
    """Mean cost of each generation, and the deviation of its cloud of Z0 and c0, of the widths of their bounds."""

    cost: NDArray[np.float64]
    cloud: NDArray[np.float64]


@pytest.fixture(scope="module")
def fit() -> Identification:
    matrix = as_matrix(records_of(2.0, "linear"), "linear")
    return Identification(matrix, Settings(model="qian2014", method="paper-ga"))


def course(fit: Identification, seed: int, **options: float) -> Course:
    search = replace(fit.search, seed=seed, options={**fit.search.options, **options})
    state = search.start()
    while not state["done"]:
        state = search.advance(state, 1)
    shown = [fit.objective.space.names.index(name) for name in ("Z0", "c0")]
    costs = [np.array(entry["errors"]) for entry in state["history"]]
    clouds = [np.array(entry["population"])[:, shown] for entry in state["history"]]
    return Course(
        np.array([cost[cost < 10].mean() for cost in costs]), np.array([cloud.std(axis=0).mean() for cloud in clouds])
    )


@pytest.fixture(scope="module")
def courses(fit: Identification) -> list[Course]:
    return [course(fit, seed) for seed in SEEDS]


def test_the_search_runs_for_the_twenty_generations_of_fig_14(courses: list[Course]) -> None:
    assert [len(one.cost) for one in courses] == [GENERATIONS] * len(SEEDS)


def test_the_cost_falls_as_in_fig_14(courses: list[Course]) -> None:
    """From 23 to 7 it falls to 0.30: here to that within 0.1 in the mean, and never rises by more than chance."""
    ratios = [one.cost[-1] / one.cost[0] for one in courses]
    assert all(0.15 < ratio < 0.6 for ratio in ratios)
    assert np.mean(ratios) == pytest.approx(LAST / FIRST, abs=0.1)
    assert max(np.diff(one.cost / one.cost[0]).max() for one in courses) < WORSE


def test_the_cloud_contracts_as_in_fig_13(courses: list[Course]) -> None:
    """At generations 1, 4, 8, 12 each cloud is smaller than the one before, the last by a quarter in the mean."""
    for one in courses:
        shown = one.cloud[[generation - 1 for generation in SHOWN]]
        assert np.all(np.diff(shown) < 0)
    assert np.mean([one.cloud[SHOWN[-1] - 1] / one.cloud[0] for one in courses]) < 0.75
    assert np.mean([one.cloud[-1] / one.cloud[0] for one in courses]) < 0.5


def test_neither_comes_out_where_mutation_redraws_over_the_bounds(fit: Identification) -> None:
    """A fifth of every column drawn from the whole of Table 2, as the text may also be read."""
    found = [course(fit, seed, over_bounds=1.0) for seed in SEEDS]
    assert np.mean([one.cost[-1] / one.cost[0] for one in found]) > 0.5
    assert np.mean([one.cloud[SHOWN[-1] - 1] / one.cloud[0] for one in found]) > 0.75


def test_half_of_the_vectors_kept_ends_after_six_generations(fit: Identification) -> None:
    """The selection ratio of the text: 200, 100, 50, 25, 12, 6 and then five."""
    assert 6 <= len(course(fit, 0, keep=0.5).cost) <= 7

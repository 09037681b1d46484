"""Each number about reduced records and fast errors decides a case that lies within a third of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.fit import reduction
from ident.fit.linear_fitness import LinearFitness
from ident.fit.reduction import Basis, ReducedRun, reduced

BASIS = Basis(1.0)


def test_the_filters_stand_where_the_scan_of_models_placed_them():
    """Pairs 0.07 apart on a line of damping 0.12 up to 1.5 times the band, and three real ones."""
    poles = np.linalg.eigvals(BASIS.filters.A)[:, 0]
    pairs, real = poles[: BASIS.pairs : 2], BASIS.filters.A[BASIS.pairs :, 0, 0]
    assert pairs.real == pytest.approx(np.full(len(pairs), -0.12))
    assert np.abs(pairs.imag) == pytest.approx(np.arange(0.035, 1.5, 0.07))
    assert -real == pytest.approx([0.03, 2.0, 5.0])


def test_a_model_is_evaluated_at_44_frequencies_and_checked_at_four():
    nodes, checks = (np.arange(44) + 0.5) / 44 * 1.6, (np.arange(4) + 0.4) / 4
    assert BASIS.nodes == pytest.approx([*nodes, *checks])


def test_what_lies_beyond_the_band_counts_a_tenth():
    """What the filters leave of a delay at the nodes, so weighted, no filter could make smaller."""
    nodes = BASIS.nodes[:44]
    delay = np.exp(-3j * BASIS.nodes)
    coefficients = BASIS.expansion @ np.concatenate([delay.real, delay.imag])
    filters = BASIS.filters.frequency_response(nodes / (2 * np.pi)).T
    weight = np.where(nodes <= 1.0, 1.0, 0.1) ** 2
    left = (filters @ coefficients - delay[:44]) * weight
    assert np.abs((filters.conj().T @ left).real).max() < 1e-6 * np.abs(left).max()


@pytest.mark.parametrize(("share", "kept"), [(0.85e-13, False), (1.15e-13, True)])
def test_a_combination_of_filters_that_a_command_shows_by_rounding_alone_is_left_out(monkeypatch, share, kept):
    """Ten of them, which a model would make felt most."""
    columns = len(BASIS.filters.D)
    felt_most = np.linalg.svd(BASIS.expansion)[0][:, :10]
    gram = np.eye(columns + 2)
    gram[:columns, :columns] -= (1.0 - share) * felt_most @ felt_most.T
    monkeypatch.setattr(reduction, "_gram", lambda *_: (gram, 0.0))
    assert (len(reduced(SimpleNamespace(), BASIS).d) > columns - 10) is kept


@pytest.mark.parametrize(("strength", "kept"), [(0.85e-6, False), (1.15e-6, True)])
def test_a_row_of_a_reduced_record_is_dropped_below_a_millionth(monkeypatch, strength, kept):
    """The first filter is shown so weakly that the weakest row has this strength, over the strongest."""

    def weakest(power: float) -> float:
        found = np.linalg.svd(np.diag([np.sqrt(power), *np.ones(columns - 1)]) @ BASIS.expansion, compute_uv=False)
        return float(found[-1] / found[0])

    columns = len(BASIS.filters.D)
    gram = np.eye(columns + 2)
    gram[0, 0] = 1e-9 * (strength / weakest(1e-9)) ** 2
    assert weakest(gram[0, 0]) == pytest.approx(strength, rel=0.05)
    monkeypatch.setattr(reduction, "_gram", lambda *_: (gram, 0.0))
    assert len(reduced(SimpleNamespace(), BASIS).d) == columns - (not kept)


class Fast(LinearFitness):
    """A fitness that is 1 for every vector, with these doubts, and exact for those that are asked for exactly."""

    doubts = np.zeros(0)
    exactly = 0
    _reduces = True

    def _fast(self, points: np.ndarray) -> Any:
        return np.arange(1.0, 1.0 + 1e-9 * len(points), 1e-9)[: len(points)], self.doubts

    def _exactly(self, points: np.ndarray) -> np.ndarray:
        """Of so many vectors more."""
        self.exactly += len(points)
        return np.full(len(points), 2.0)


def of_samples(count: int) -> Fast:
    run = SimpleNamespace(length=count, begins="moving")
    return Fast(None, None, (run,), SimpleNamespace(followed=False), None)


@pytest.mark.parametrize(
    ("leading", "others", "exactly"),
    [(0.043, 0.0, 0), (0.057, 0.0, 5), (0.0, 0.17, 0), (0.0, 0.23, 3), (0.057, 0.17, 5)],
)
def test_doubtful_vectors_are_evaluated_exactly_where_they_lead_or_are_few(leading, others, exactly):
    """Of a hundred the first twentieth leads; three others are fewer than that."""
    fitness = of_samples(1_000_000)
    fitness.doubts = np.array([leading] * 5 + [0.0] * 92 + [others] * 3)
    fitness.doubts[5:9] = leading
    fitness.errors(np.zeros((100, 1)))
    assert fitness.exactly == exactly


def test_of_few_samples_more_of_the_doubtful_vectors_are_evaluated_exactly():
    """Of 20,000 samples twenty vectors a generation, where every one of a hundred is doubtful."""
    fitness = of_samples(20_000)
    fitness.doubts = np.ones(100)
    fitness.errors(np.zeros((100, 1)))
    assert fitness.exactly == 20


@pytest.mark.parametrize(("samples", "simulated"), [(85_000, True), (115_000, False)])
def test_records_of_steps_are_simulated_up_to_a_hundred_thousand_samples(samples, simulated):
    run = SimpleNamespace(length=samples, begins="at rest", hold="zoh", kind="step")
    fitness = LinearFitness(None, None, (run,), None, None)
    assert fitness._reduces is not simulated


@pytest.mark.parametrize(("left", "doubted"), [(0.085, True), (0.115, False)])
def test_a_record_that_is_a_decay_alone_is_evaluated_exactly(left, doubted):
    """So much of its power is left once first states of all kinds are allowed."""
    nodes = len(BASIS.nodes)
    run = ReducedRun(np.zeros((1, 2 * nodes)), np.array([np.sqrt(0.6 * left)]), 0.4 * left, 1.0)
    assert run.shown == pytest.approx(left)
    errors, doubt = run.errors(np.ones((2, 2 * nodes)), BASIS)
    assert errors == pytest.approx(np.sqrt(left))
    assert np.isinf(doubt).all() == doubted

"""A record rings where a mass behind a spring answers, not where a lag does; there springs are looked for."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import scipy

from ident.diagnosis.candidate_models import CandidateModels
from ident.effects import CATALOGUE, needs
from ident.effects import ringing as of_records
from ident.effects.ringing import ringing
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from tests.presets.test_two_masses import SEEN, matrix


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("seen", [0, 1])
def test_drive_and_load_ring_at_any_rate_of_sampling(seed, seen):
    """As they were recorded, and from sixteen samples between each two, with noise of their own."""
    run = matrix(seed, seen).runs[0]
    assert ringing(run.command, run.measured) is not None
    t, fine = np.arange(run.length), np.arange(16 * (run.length - 1)) / 16
    noise = 0.005 * run.measured.std() * np.random.default_rng(seed).standard_normal(len(fine))
    assert ringing(np.interp(fine, t, run.command), np.interp(fine, t, run.measured) + noise) is not None


def positions(speed: np.ndarray, rate: float, seed: int) -> np.ndarray:
    """The way of a speed, with noise of 0.1 % of its own."""
    way = np.cumsum(speed) / rate
    return way + 0.001 * way.std() * np.random.default_rng([67, seed]).standard_normal(len(way))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("seen", [0, 1])
def test_a_position_rings_that_integrates(seed, seen):
    """Least squares alone are misled by the noise of the position at most seeds."""
    run = matrix(seed, seen).runs[0]
    assert ringing(run.command, positions(run.measured, run.sample_rate, seed), integrates=True) is not None


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("constant", [2.0, 10.0, 50.0])
def test_a_lag_does_not_ring(seed, constant):
    rng = np.random.default_rng([535, seed])
    u, y = np.repeat(rng.uniform(-3.0, 3.0, 250), 8), np.zeros(2000)
    for k in range(1, len(y)):
        y[k] = y[k - 1] + (u[k - 1] - y[k - 1]) * -np.expm1(-1.0 / constant)
    assert ringing(u, y + 0.01 * y.std() * rng.standard_normal(len(y))) is None


def test_few_lags_ring_by_their_positions():
    """At most six of eighteen: an offer of two effects more, and no verdict."""
    found = 0
    for seed, constant in product(range(6), (2.0, 10.0, 50.0)):
        rng = np.random.default_rng([535, seed])
        u = np.repeat(rng.uniform(-3.0, 3.0, 250), 8)
        y = scipy.signal.lfilter([0.0, 1.0], [1.0, -np.exp(-1.0 / constant)], u) * -np.expm1(-1.0 / constant)
        found += ringing(u, positions(y, 100.0, seed), integrates=True) is not None
    assert found <= 6


def test_a_spring_is_looked_for_where_a_record_rings_and_no_oil_is_one():
    run = matrix(0, 0).runs[0]
    still = Run("still", "", run.sample_rate, {"command": run.command, "velocity": np.cumsum(run.command) / 100.0},
                run.units, output="velocity")  # fmt: skip

    def springs(model: str, one: Run) -> set[str]:
        return set(SEEN) & set(CandidateModels.of(Matrix(Actuator("A"), (one,)), Settings(model=model)).effects)

    assert springs("motor", run) == set(SEEN)
    assert not springs("motor", still)
    assert not springs("open_valve", run)


def test_a_record_is_looked_at_once_by_the_effects_of_two_masses(monkeypatch):
    """Two effects need a resonance, and so does each machine that is compared; another record is looked at anew."""
    looked_at = []

    def counting(command, output, integrates):
        looked_at.append(len(output))
        return ringing(command, output, integrates)

    monkeypatch.setattr(of_records, "ringing", counting)
    asked = [effect.needs for effect in CATALOGUE if effect.needs is needs.resonant]
    assert len(asked) == 2
    of, other = (replace(one, runs=tuple(map(replace, one.runs))) for one in (matrix(0, 0), matrix(1, 0)))
    assert all(need(of) for need in asked)
    assert len(looked_at) == len(of.of_use("fit"))
    assert needs.resonant(other)
    assert len(looked_at) == 2 * len(of.of_use("fit"))

"""A record rings where a mass behind a spring answers, not where a lag does; there springs are looked for."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import scipy

from ident.diagnosis.candidate_models import CandidateModels
from ident.effects import ringing as of_records
from ident.effects.ringing import modes, resonance
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from tests.presets.test_two_masses import SEEN, matrix
from tests.short_form import short_form


def recorded(command: np.ndarray, output: np.ndarray, name: str = "a", rate: float = 1.0) -> Run:
    return Run(name, "", rate, {"command": command, "displacement": output}, {"command": "V", "displacement": "rad"})


@pytest.mark.parametrize("seed", short_form(range(4), 2))
@pytest.mark.parametrize("seen", [0, 1])
def test_drive_and_load_ring_at_any_rate_of_sampling(seed, seen):
    """As they were recorded, and from sixteen samples between each two, with noise of their own."""
    run = matrix(seed, seen).runs[0]
    assert resonance([run]) is not None
    t, fine = np.arange(run.length), np.arange(16 * (run.length - 1)) / 16
    noise = 0.005 * run.measured.std() * np.random.default_rng(seed).standard_normal(len(fine))
    finer = recorded(np.interp(fine, t, run.command), np.interp(fine, t, run.measured) + noise)
    assert resonance([finer]) is not None


def positions(speed: np.ndarray, rate: float, seed: int) -> np.ndarray:
    """The way of a speed, with noise of 0.1 % of its own."""
    way = np.cumsum(speed) / rate
    return way + 0.001 * way.std() * np.random.default_rng([67, seed]).standard_normal(len(way))


@pytest.mark.parametrize("seen", short_form([0, 1], 1))
def test_positions_ring_that_integrate(seen):
    """At seven seeds of eight at least. Least squares alone are misled by the noise of the position at most seeds."""
    runs = [matrix(seed, seen).runs[0] for seed in range(8)]
    shown = [recorded(run.command, positions(run.measured, run.sample_rate, seed)) for seed, run in enumerate(runs)]
    assert sum(resonance([one]) is not None for one in shown) >= 7


def noisy(u: np.ndarray, speed: np.ndarray, seed: int, name: str = "a") -> Run:
    """With noise of 1 % of the speed."""
    noise = np.random.default_rng([541, seed]).standard_normal(len(speed))
    return recorded(u, speed + 0.01 * speed.std() * noise, name)


def steps(seed: int) -> np.ndarray:
    return np.repeat(np.random.default_rng([542, seed]).uniform(-3.0, 3.0, 75), 8)


def loaded(seed: int, share: float = 0.4) -> Run:
    """The speed of a drive of which a share of the mass is behind a spring, at 0.3 rad a sample alone."""
    k, d = share * 0.09, 0.03 * share
    rates = [
        [-(0.04 + d) / (1.0 - share), d / (1.0 - share), -k / (1.0 - share)],
        [d / share, -d / share, k / share],
        [1.0, -1.0, 0.0],
    ]
    driven = ([[0.1 / (1.0 - share)], [0.0], [0.0]], [[1.0, 0.0, 0.0]], [[0.0]])
    held = scipy.signal.cont2discrete(tuple(np.array(of) for of in (rates, *driven)), 1.0)
    return noisy(steps(seed), scipy.signal.dlsim(held, steps(seed))[1][:, 0], seed, f"{seed}")


def rubbing(seed: int) -> Run:
    """The speed of a drive with as much dry friction as its motor gives in a third of the time."""
    u, speed = steps(seed), np.zeros(600)
    for k in range(599):
        free = speed[k] + 0.1 * u[k] - 0.04 * speed[k]
        speed[k + 1] = np.sign(free) * max(abs(free) - 0.1, 0.0)
    return noisy(u, speed, seed)


def test_a_load_behind_a_spring_is_seen_in_noise_and_dry_friction_is_none():
    """Of one run, and of two; a linear equation bent by friction differs from run to run."""
    springs, dry = [loaded(seed) for seed in range(8)], [rubbing(seed) for seed in range(40)]
    assert sum(resonance([one]) is not None for one in springs) >= 7
    assert sum(resonance(pair) is not None for pair in zip(springs[::2], springs[1::2], strict=True)) == 4
    assert sum(resonance([one]) is not None for one in dry[:8]) <= 4
    assert sum(resonance(pair) is not None for pair in zip(dry[::2], dry[1::2], strict=True)) <= 4


def test_of_two_runs_one_may_show_the_spring_in_both_of_its_halves():
    """A belt that is stiffer at another speed swings at another frequency in each run."""
    assert sum(resonance([loaded(seed), loaded(seed + 1, 0.15)]) is not None for seed in range(0, 8, 2)) >= 3


def test_the_frequency_is_that_of_the_machine_at_the_rate_of_each_run():
    """Two runs, one of them of half the rate: the drive and the load swing against each other."""
    one, other = loaded(0), loaded(1)
    half = recorded(other.command[::2], other.measured[::2], "half", 0.5)
    assert resonance([one, half]) == pytest.approx(0.3 / np.sqrt(0.6), rel=0.1)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("constant", [2.0, 10.0, 50.0])
def test_a_lag_does_not_ring(seed, constant):
    rng = np.random.default_rng([535, seed])
    u, y = np.repeat(rng.uniform(-3.0, 3.0, 250), 8), np.zeros(2000)
    for k in range(1, len(y)):
        y[k] = y[k - 1] + (u[k - 1] - y[k - 1]) * -np.expm1(-1.0 / constant)
    assert resonance([recorded(u, y + 0.01 * y.std() * rng.standard_normal(len(y)))]) is None


def test_few_lags_ring_by_their_positions():
    """At most one of eighteen: an offer of two effects more, and no verdict."""
    found = 0
    for seed, constant in product(range(6), (2.0, 10.0, 50.0)):
        rng = np.random.default_rng([535, seed])
        u = np.repeat(rng.uniform(-3.0, 3.0, 250), 8)
        y = scipy.signal.lfilter([0.0, 1.0], [1.0, -np.exp(-1.0 / constant)], u) * -np.expm1(-1.0 / constant)
        found += resonance([recorded(u, positions(y, 100.0, seed))]) is not None
    assert found <= 1


def springs(model: str, one: Run) -> dict[str, bool]:
    """The springs between masses that a diagnosis offers, and whether it tries them whatever is predicted."""
    models = CandidateModels.of(Matrix(Actuator("A"), (one,)), Settings(model=model))
    return {name: models.is_called_for(name) for name in SEEN if name in models.effects}


def test_a_spring_is_always_tried_where_a_record_rings_and_offered_where_there_is_no_oil():
    run = matrix(0, 0).runs[0]
    still = Run(
        "still",
        "",
        run.sample_rate,
        {"command": run.command, "velocity": np.cumsum(run.command) / 100.0},
        run.units,
        output="velocity",
    )
    assert springs("motor", run) == dict.fromkeys(SEEN, True)
    assert springs("motor", still) == dict.fromkeys(SEEN, False)
    assert not springs("open_valve", run)


def test_a_record_is_looked_at_once_by_the_effects_of_two_masses(monkeypatch):
    """Two effects ask for a resonance, for each model; another record is looked at anew."""
    looked_at = []

    def counting(command, output):
        looked_at.append(len(output))
        return modes(command, output)

    monkeypatch.setattr(of_records, "modes", counting)
    of, other = (replace(one.runs[0]) for one in (matrix(0, 0), matrix(1, 0)))
    assert all(springs("motor", of).values())
    assert looked_at == [400, 200, 200]
    springs("motor", other)
    assert len(looked_at) == 6


def test_a_model_of_fewer_poles_has_an_answer():
    """Its last coefficient is zero, and so is a pole; another one lies outside of the unit circle."""
    found = np.array([2.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0])
    answer = of_records._answer(found, np.eye(6)[0])
    assert answer == pytest.approx(0.5 ** np.arange(6))

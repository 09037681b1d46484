"""The modes of a record have the decay of the machine's poles, within the standard errors that they state."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import cont2discrete, lfilter

from ident.checks.modes import modes


def answered(damping: float, frequency: float, driven: np.ndarray) -> np.ndarray:
    """What a mass on a spring makes of a held force: x'' + 2 D w x' + w² x = w² u, w in rad a sample, by SciPy."""
    w = frequency
    numerator, denominator, _ = cont2discrete(([w * w], [1.0, 2.0 * damping * w, w * w]), 1.0)
    return np.asarray(lfilter(numerator.ravel(), denominator, driven))


def piece(*signals: np.ndarray) -> np.ndarray:
    return np.stack([(one - one.mean()) / one.std() for one in signals])


def nearest(frequency: float, *pieces: np.ndarray):
    return min(modes(pieces), key=lambda one: abs(one.frequency - frequency))


def test_the_standard_error_of_a_decay_is_how_far_it_scatters():
    """60 records of a mode of 2 % damping that noise drives, over 60 periods: deviations over errors are of size 1."""
    off = []
    for seed in range(60):
        y = answered(0.02, 0.7, np.random.default_rng([1, seed]).standard_normal(1200))[660:]
        found = nearest(0.7, piece(y))
        off.append((found.decay - 0.02 * 0.7) / found.error)
    assert abs(np.mean(off)) < 1.0
    assert np.std(off) == pytest.approx(1.0, abs=0.35)


@pytest.mark.parametrize("noise", [0.0, 0.01])
def test_a_mode_that_a_command_drives_is_found_beside_a_slower_and_a_quicker_one(noise):
    """Each of the three is a third of the output. Noise damps a mode, and never takes damping away."""
    rng = np.random.default_rng(2)
    u = rng.standard_normal(3000)
    y = sum(x / x.std() for x in (answered(d, w, u) for d, w in ((0.3, 0.15), (0.03, 0.6), (0.1, 1.1))))
    found = nearest(0.6, piece(y + noise * y.std() * rng.standard_normal(len(y)), u))
    assert found.frequency == pytest.approx(0.6, rel=0.01)
    assert found.decay == pytest.approx(0.03 * 0.6, rel=0.001) if not noise else found.decay > 0.03 * 0.6


@pytest.mark.parametrize("frequency", [0.005, 0.05, 1.1])
def test_a_mode_is_found_however_finely_it_is_sampled(frequency):
    """A free oscillation of 4 % damping with a hundredth of noise."""
    k = np.arange(round(40 / frequency))
    y = np.exp(-0.04 * frequency * k) * np.sin(frequency * k)
    found = nearest(frequency, piece(y + 0.01 * y.std() * np.random.default_rng(3).standard_normal(len(k))))
    assert found.frequency == pytest.approx(frequency, rel=0.02)
    assert found.decay / found.frequency == pytest.approx(0.04, abs=0.01)


def test_pieces_of_a_record_tell_a_mode_together_and_few_samples_tell_none():
    y = answered(0.02, 0.7, np.random.default_rng(4).standard_normal(600))
    parts = [piece(part) for part in np.array_split(y, 20)]
    assert nearest(0.7, *parts).decay == pytest.approx(0.014, abs=0.012)
    assert not list(modes([piece(y[:28])]))
    assert not list(modes([]))

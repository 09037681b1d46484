"""What of a residual its own past does not foretell, whatever its colour."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lfilter

from ident.noise import autoregression
from ident.noise.autoregression import prediction_errors

N = 4000


@pytest.fixture
def rng():
    """A stated seed."""
    return np.random.default_rng(20)


def coloured(white: np.ndarray) -> np.ndarray:
    """What a sensor with a memory adds."""
    return lfilter([1.0], [1.0, -0.6], white)


def ringing(white: np.ndarray) -> np.ndarray:
    """A mode that the noise excites: poles of radius 0.95 at a tenth of the sample rate."""
    return lfilter([1.0], [1.0, -1.9 * np.cos(0.2 * np.pi), 0.95**2], white)


@pytest.mark.parametrize("made", [lambda white: white, coloured, np.cumsum, ringing])
def test_what_is_new_in_each_sample_is_left(made, rng):
    """White noise, coloured, summed up, and ringing: what drove it comes back, less 32 parameters of 4,000 samples."""
    white = rng.standard_normal(N)
    left = prediction_errors(made(white))
    assert np.corrcoef(left[100:], white[100:])[0, 1] > 0.99
    assert np.std(left[100:]) == pytest.approx(np.std(white[100:]), rel=0.02)


def test_a_drift_is_foretold_however_large(rng):
    white = rng.standard_normal(N)
    slow = 1e3 * np.sin(np.linspace(0.0, 5.0, N)) + 1e6
    assert np.std(prediction_errors(white + slow)[100:]) < 1.1 * np.std(white)


def test_its_size_and_level_do_not_matter(rng):
    residual = coloured(rng.standard_normal(N))
    np.testing.assert_allclose(prediction_errors(1e-6 * residual + 3.0), 1e-6 * prediction_errors(residual), atol=1e-12)


@pytest.mark.parametrize("residual", [np.zeros(500), np.full(500, 0.1), np.zeros(5), np.array([1.0, 2.0])])
def test_what_does_not_move_and_what_is_too_short_leaves_nothing(residual):
    assert np.abs(prediction_errors(residual)).max() < 1e-12


def test_what_runs_away_is_foretold_and_of_what_is_infinite_nothing_is_known():
    with np.errstate(all="raise"):
        assert np.abs(prediction_errors(np.geomspace(1.0, 1e300, 500))).max() < 1e295
    with np.errstate(invalid="ignore"):
        assert np.isnan(prediction_errors(np.append(np.zeros(499), np.inf))).all()


def test_a_long_record_is_taken_in_blocks(rng, monkeypatch):
    """What the records before a block foretell of its first samples is not lost."""
    residual = coloured(rng.standard_normal(N)) + np.cumsum(rng.standard_normal(N))
    at_once = prediction_errors(residual)
    monkeypatch.setattr(autoregression, "_BLOCK", 300)
    np.testing.assert_allclose(prediction_errors(residual), at_once, atol=1e-10)

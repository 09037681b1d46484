"""A mass that nothing holds, pushed by its command and by what nobody measured: windows begin with its speed, too."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import solve_discrete_are

from ident.fit import identification
from ident.fit.multiple_shooting import ShootingWindows, gains
from ident.fit.result import Combination, FitResult
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import identify

RATE, GAIN = 20.0, 2.0
SETTINGS = Settings(model="motor", options={"population": 24, "generations": 6, "elite": 3})


def pushed(seed: int, wander: float = 0.02, drag: float = 0.0, seconds: float = 60.0) -> Matrix:
    """ẍ = GAIN u − drag ẋ of held u, in a hundred steps a sample, with v[k+1] = … + wander; the noise is 5 mm."""
    random, dt = np.random.default_rng([41, seed]), 0.01 / RATE
    u = np.repeat(random.choice([-1.0, 1.0], int(seconds / 1.5)) * random.uniform(0.5, 1, int(seconds / 1.5)), 30)
    u -= u.mean()
    u[:20] = 0.0
    x, v, place = np.zeros(len(u)), 0.0, 0.0
    for k in range(len(u) - 1):
        for _ in range(100):
            before = v
            v += dt * (GAIN * u[k] - drag * v)
            place += 0.5 * dt * (before + v)
        v += wander * random.standard_normal()
        x[k + 1] = place
    x += 5e-3 * random.standard_normal(len(u))
    run = Run("r", "", RATE, {"command": u, "displacement": x}, {"command": "V", "displacement": "m"}, hold="zoh")
    return Matrix(Actuator("CART"), (run,))


def acceleration(fit: FitResult) -> Combination:
    """What the data determine of a mass that nobody knows: Kt/m0."""
    return next(known for known in fit.determined if known.expression == "Kt / m0")


def test_its_gain_is_not_biased_and_its_standard_error_holds(full):
    found = []
    for seed in range(48 if full else 8):
        fit = identify(pushed(seed), SETTINGS)
        assert fit.window is not None
        assert fit.window.memory is not None
        assert type(fit).from_json(fit.to_json()).window == fit.window
        found.append(acceleration(fit))
    z = np.array([(one.value - GAIN) / one.std_error for one in found])
    assert abs(z.mean()) < 1.0
    assert np.mean(np.abs(z) < 1.96) > 0.75
    off = np.array([one.value for one in found]) / GAIN - 1
    assert off.std() < 0.03
    assert abs(off.mean()) < 3 * off.std() / np.sqrt(len(off))


@pytest.mark.full
def test_over_whole_runs_the_gain_is_where_the_disturbances_took_the_record(monkeypatch):
    monkeypatch.setattr(identification, "in_windows", lambda optimum, *_, **__: optimum)
    off = [acceleration(identify(pushed(seed), SETTINGS)).value / GAIN - 1 for seed in range(8)]
    assert np.std(off) > 0.06


def test_a_drive_without_disturbances_whose_speed_lasts_is_fitted_whole():
    fit = identify(pushed(1, wander=0.0, drag=0.02), SETTINGS)
    assert fit.window is None
    assert acceleration(fit).value == pytest.approx(GAIN, rel=2e-3)


@pytest.mark.parametrize("memory", [0.0, 3.0, 20.0])
def test_white_noise_over_windows_is_as_large_as_is_said(memory):
    anchoring = ShootingWindows(16, memory)
    noise = np.random.default_rng(3).standard_normal(320_000)
    assert np.mean(anchoring(noise) ** 2) == pytest.approx(anchoring.noise, rel=0.03)


def test_a_signal_in_parts_is_the_whole_signal():
    anchoring, signal = ShootingWindows(8, 5.0), np.random.default_rng(4).standard_normal((100, 2, 3))
    stream = anchoring.from_start()
    parts = [stream(signal[first : first + 24]) for first in range(0, 100, 24)]
    assert np.allclose(np.concatenate(parts), anchoring(signal))


def test_a_speed_that_was_there_before_is_taken_away_and_no_other():
    """A steady slope is known after some memories of the filter, from the data before; a kink in a window stays."""
    k = np.arange(200.0)
    left = ShootingWindows(20, 4.0)(0.3 * k)
    assert np.abs(left[100:]).max() < 1e-6
    kinked = ShootingWindows(20, 4.0)(np.maximum(k - 110, 0.0))
    assert kinked[119] == pytest.approx(9.0)


def test_where_a_record_begins_is_no_speed():
    """It was one of the whole first sample, so that the first window led far away."""
    assert np.abs(ShootingWindows(20, 1.2)(np.full((60, 2), 3.0))).max() < 1e-9
    signal = np.random.default_rng(5).standard_normal(100)
    assert np.allclose(ShootingWindows(20, 1.2)(signal + 7.0), ShootingWindows(20, 1.2)(signal))


def test_the_gains_are_those_of_the_steady_riccati_equation():
    """Of x, v with white acceleration: the Kalman gain of scipy's discrete Riccati equation."""
    for memory in (2.0, 10.0):
        F, H, g = np.array([[1.0, 1.0], [0.0, 1.0]]), np.array([[1.0, 0.0]]), np.array([[0.5], [1.0]])
        P = solve_discrete_are(F.T, H.T, g @ g.T / memory**4, np.eye(1))
        K = P @ H.T / (H @ P @ H.T + 1)
        assert gains(memory) == pytest.approx(tuple(K[:, 0]), rel=1e-6)

"""What answers the rate of its command leads by a zero; channels that are shifted lead by samples."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import signal

from ident.checks.check import check
from ident.matrix import Actuator, Matrix
from ident.run import Run

RATE = 500.0


def texts(numerator: list[float], denominator: list[float], band: float, shift: int = 0) -> list[str]:
    """What the check says of the delay of a transfer function under noise up to `band` Hz; SciPy simulates it."""
    rng, t = np.random.default_rng(1), np.arange(15000) / RATE
    command = signal.lfilter(*signal.butter(4, [0.3, band], "bandpass", fs=RATE), rng.normal(0, 1, len(t)))
    shown = np.roll(signal.lsim((numerator, denominator), command, t)[1], shift)
    shown += rng.normal(0, 1e-3 * np.std(shown), len(t))
    run = Run("a", "a.csv", RATE, {"command": command, "displacement": shown}, dict.fromkeys(CHANNELS, "m"))
    return [one.text for one in check(Matrix(Actuator("A"), (run,))) if one.code == "delay"]


CHANNELS = ("command", "displacement")


@pytest.mark.parametrize(("frequency", "damping"), [(27.0, 0.14), (27.0, 0.5), (60.0, 0.7), (60.0, 1.2)])
def test_a_mass_on_a_base_that_moves_is_not_shifted(frequency, damping):
    """Thomson, Theory of Vibration, support motion: (2 ζ ω s + ω²)/(s² + 2 ζ ω s + ω²)."""
    rate = 2 * damping * frequency
    assert texts([rate, frequency**2], [1.0, rate, frequency**2], band=15.0) == []


def test_a_loop_with_a_feed_forward_of_the_speed_is_not_shifted():
    """x' = K (r − x) + 0.8 r' behind a valve: (0.8 s + K)/(s + K), with two poles of the valve."""
    valve = [1 / 150.0**2, 1.4 / 150.0, 1.0]
    assert texts([0.8, 20.0], list(np.polymul([1.0, 20.0], valve)), band=15.0) == []


LOOP = list(np.polymul([1 / 40.0, 1.0], [1 / 120.0**2, 0.8 / 120.0, 1.0]))


@pytest.mark.parametrize(("shift", "said"), [(-8, "which no actuator can"), (-1, "Either its channels are shifted")])
def test_channels_that_are_shifted_are_found(shift, said):
    """A shift by one sample is the same as a zero within the band; of eight samples it is a shift."""
    (found,) = texts([1.0], LOOP, band=40.0, shift=shift)
    assert said in found
    assert "correct columns or rows" in found

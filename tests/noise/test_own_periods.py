"""A command that is run several times without a break shows the noise of its record, in the band of the command too."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lfilter, max_len_seq

from ident.noise.floor import noise_floors
from ident.noise.own_periods import own_repeats, period
from ident.run import Run

RATE, BITS = 100.0, 7
EDGE = np.pi * RATE


def binary(periods: float, each: int = 4) -> np.ndarray:
    """A random binary sequence of 127 bits of so many samples, repeated."""
    bits = 2.0 * max_len_seq(BITS)[0] - 1.0
    one = np.repeat(bits, each)
    return np.tile(one, int(np.ceil(periods)))[: round(periods * len(one))]


def multisine(periods: float, samples: int = 400, seed: int = 0) -> np.ndarray:
    """Twelve sines of random phases, none of which has half of the power."""
    rng = np.random.default_rng(seed)
    t = np.arange(round(periods * samples)) / samples
    return np.sum([np.sin(2 * np.pi * (k * t + rng.random())) for k in range(3, 15)], axis=0)


def moved(command: np.ndarray, disturbance: float, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """A mass on a spring, by SciPy, and what disturbs it: noise through the same filter, as large as stated."""
    rng = np.random.default_rng(seed)
    b, a = [0.0, 0.005], [1.0, -1.94, 0.945]
    answer = lfilter(b, a, command)
    noise = lfilter(b, a, rng.standard_normal(len(command)))
    return answer, disturbance * np.std(answer) * noise / np.std(noise)


def record(command: np.ndarray, measured: np.ndarray) -> Run:
    return Run(
        "r", "", RATE, {"command": command, "displacement": measured}, {"command": "V", "displacement": "m"}, hold="zoh"
    )


@pytest.mark.parametrize("command", [binary(5), multisine(6), np.concatenate([np.zeros(300), multisine(5)])])
def test_a_disturbance_in_the_band_of_the_command_is_noise(command):
    """Of which the spectrum above the command shows nothing; the start of the machine is none."""
    answer, noise = moved(command, 0.2)
    floors = noise_floors([record(command, answer + noise)], EDGE)
    share = np.std(noise) / np.std(answer + noise)
    assert floors.measured
    assert floors.in_band
    assert floors.by_run["r"] == pytest.approx(share, rel=0.25)


def test_a_start_that_dies_away_within_a_period_is_no_noise():
    command = binary(4)
    answer, noise = moved(command, 1e-3)
    started = answer + np.std(answer) * 5.0 * np.exp(-np.arange(len(answer)) / 60.0)
    assert noise_floors([record(command, started + noise)], EDGE).by_run["r"] < 0.01


def test_a_command_whose_height_changes_is_compared_behind_the_change():
    """Half of the record at three halves of the voltage; what comes before the change is compared no more."""
    command = multisine(40, samples=200) * np.repeat([1.0, 1.5], 4000)
    answer, noise = moved(command, 0.1)
    pairs = own_repeats(record(command, answer + noise))
    assert 16 <= len(pairs) <= 19
    assert all(np.allclose(a.command, b.command) for a, b, _ in pairs)


@pytest.mark.parametrize(
    "command",
    [
        np.random.default_rng(2).standard_normal(4000),
        np.repeat([0.0, 1.0], [50, 3950]),
        np.linspace(0.0, 1.0, 4000),
        np.zeros(4000),
        np.sin(2 * np.pi * np.arange(4000) / 400),
        multisine(2),
        np.repeat(np.random.default_rng(3).choice([-1.0, 0.0, 1.0], 20), 200),
    ],
)
def test_what_does_not_repeat_itself_has_no_periods(command):
    """Noise, a step, a ramp, a rest, steps at random; of a sine the noise is told by its phase."""
    assert not own_repeats(record(command, np.random.default_rng(4).standard_normal(len(command))))


def test_the_period_is_found_to_the_sample():
    assert period(binary(5, each=3)) == 381
    assert period(multisine(7, samples=333)) == 333
    assert period(np.concatenate([np.zeros(400), binary(4)])) == 508

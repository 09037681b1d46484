"""The noise of a periodic record is told between the lines that friction's jumps fill its spectrum with."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.matrix import Run
from ident.noise.floor import noise_floor, noise_floors
from ident.noise.periodic import fundamental
from tests.diagnosis.damper import Damper, dahl

NOISE = {0: 0.002, 1: 0.01, 2: 0.03}


def record(seed: int, samples: float, periods: float, noise: float, triangle: bool = False) -> Run:
    """A damper with friction under a sine or a triangle of so many samples a period; the force with white noise."""
    rng = np.random.default_rng([51, seed])
    t = np.arange(int(samples * periods)) / samples
    phase = rng.uniform()
    if triangle:
        x = 4 * np.abs((t + phase) % 1.0 - 0.5) - 1.0
        v = -4 * np.sign((t + phase) % 1.0 - 0.5) * -1.0
    else:
        x, v = np.sin(2 * np.pi * (t + phase)), 2 * np.pi * np.cos(2 * np.pi * (t + phase))
    force = v + 0.5 * x + float(rng.uniform(1, 5)) * dahl(x, float(rng.choice([1e-4, 0.02])))
    measured = force + noise * np.std(force) * rng.standard_normal(len(t))
    channels = {"command": v, "velocity": v, "force": measured}
    return Run(f"{seed}", "", samples, channels, {"velocity": "m/s", "force": "N"}, output="force")


@pytest.mark.parametrize("seed", range(12))
def test_the_floor_of_a_periodic_record_is_its_noise(seed):
    """20 to 1000 samples a period, a whole number or not, 8 to 100 periods, sines and triangles: within 1.3."""
    rng = np.random.default_rng([52, seed])
    samples = float(np.exp(rng.uniform(np.log(20), np.log(1000))))
    samples = round(samples) if seed % 2 else samples
    periods = min(float(rng.uniform(8, 100)), 60_000 / samples)
    noise = NOISE[seed % 3]
    run = record(seed, samples, periods, noise, triangle=seed % 4 == 3)
    told = noise_floor(run, 3.0 * 2 * np.pi)
    assert noise / 1.3 < told < 1.3 * noise, (samples, periods, noise, told)


@pytest.mark.parametrize("periodic", [True, False])
def test_only_periods_or_repeats_tell_the_noise_at_the_frequencies_of_the_command(periodic):
    run = record(3, 100 / 3, 27.0, 0.02)
    command = run.command if periodic else np.random.default_rng(3).standard_normal(len(run.command))
    found = noise_floors([replace(run, channels={**run.channels, "command": command})], 2 * np.pi)
    assert (found.measured, found.in_band) == (False, periodic)


def test_the_lines_that_are_folded_back_are_no_noise():
    """Fifty samples in one and a half periods: the jumps beyond half the sample rate stand between the multiples."""
    run = record(3, 100 / 3, 27.0, 0.02)
    assert 0.02 / 1.2 < noise_floor(run, 2 * np.pi) < 1.2 * 0.02


def test_the_fundamental_is_found_to_a_thousandth_of_a_bin():
    v, _ = Damper(cycles=20.3).force()
    assert fundamental(v, 100.0) == pytest.approx(0.8, abs=1e-3 * 100.0 / len(v))


@pytest.mark.parametrize("of", ["noise", "sweep", "few periods"])
def test_what_does_not_repeat_is_not_periodic(of):
    n = np.arange(4096)
    signals = {
        "noise": np.random.default_rng(53).standard_normal(len(n)),
        "sweep": np.sin(2 * np.pi * n * (0.001 + 0.01 * n / len(n))),
        "few periods": np.sin(2 * np.pi * 3 * n / len(n)),
    }
    assert fundamental(signals[of], 1.0) is None

"""What a command is taken to do between its samples, where nobody says."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

from ident import from_arrays
from ident.errors import Unusable
from ident.readers.hold import Spectrum, are_band_limited
from ident.run import BENCH

K = np.arange(4000)


def multisine(top: float) -> np.ndarray:
    """Sixty sines with random phases up to a share of half the sample rate."""
    rng = np.random.default_rng(4)
    omega = np.pi * rng.uniform(0.01, top, 60)
    return np.sin(np.multiply.outer(K, omega) + 2 * np.pi * rng.random(60)).sum(axis=1)


def noise(share: float) -> np.ndarray:
    """White noise up to a share of half the sample rate."""
    spectrum = np.fft.rfft(np.random.default_rng(5).standard_normal(len(K)))
    spectrum[int(share * len(spectrum)) :] = 0.0
    return np.fft.irfft(spectrum, len(K))


def held(dwell: int) -> np.ndarray:
    return np.repeat(np.random.default_rng(6).standard_normal(len(K) // dwell + 1), dwell)[: len(K)]


def triangle(period: float) -> np.ndarray:
    return np.abs(K / period % 1.0 - 0.5)


def measured(command: np.ndarray, **stated: Any) -> tuple[str, Mapping[str, Any]]:
    """The hold of a record of a command, and what was told."""
    arrays, units = {"command": command, "displacement": np.cumsum(command)}, {"command": "V", "displacement": "mm"}
    matrix = from_arrays(arrays, units=units, sample_rate="100 Hz", **stated)
    return matrix.runs[0].hold, matrix.notices


def test_what_lines_lose_of_a_sine_is_its_droop():
    found = Spectrum.of(np.sin(2 * np.pi * 0.2 * K))
    assert found.lost == pytest.approx(1 - np.sinc(0.2) ** 2, rel=1e-4)
    assert found.top < 1e-12
    assert found.filled < 2.5


@pytest.mark.parametrize("command", [multisine(0.66), noise(0.85), 3.0 + multisine(0.4), noise(0.12)])
def test_a_command_that_ends_below_half_the_rate_is_band_limited_and_it_is_told(command):
    hold, (told,) = measured(command)
    assert hold == "band-limited"
    assert "hold: band-limited" in told


@pytest.mark.parametrize("hold", ["linear", "zoh"])
def test_what_is_stated_is_obeyed(hold):
    assert measured(multisine(0.66), hold=hold) == (hold, ())
    assert measured(held(1), hold="band-limited") == ("band-limited", ())


def test_lines_stay_where_the_command_is_held_has_corners_is_one_tone_or_is_sampled_finely():
    """However long it is held, and from corner to corner; noise of 80 Hz at 4096 Hz loses next to nothing."""
    corners = [triangle(period) for period in np.geomspace(2.2, 300, 60)]
    steps = [held(dwell) for dwell in (1, 2, 3, 7, 20, 70, 300, 1500)]
    switched = [np.sign(np.sin(2 * np.pi * K / period)) for period in (2.5, 9.0, 40.0, 333.3)]
    fine = [noise(80 / 2048), multisine(0.06), np.sin(2 * np.pi * K / 20), np.sin(K)]
    assert not any(are_band_limited([command]) for command in (*corners, *steps, *switched, *fine))
    assert measured(held(20)) == ("linear", ())


def test_one_run_that_is_not_band_limited_says_it_of_all():
    """One rig has made them; what moves slowly takes part, and what is short or stands still says nothing."""
    smooth, slow = multisine(0.66), multisine(0.06)
    assert are_band_limited([slow, smooth, np.zeros(500), held(1)[:20]])
    assert not are_band_limited([smooth, held(1)])


def test_the_current_of_a_bench_is_none():
    stated = {"units": {"current": "mA", "displacement": "mm"}, "sample_rate": "100 Hz", "kind": BENCH[1]}
    arrays = {"current": multisine(0.66), "displacement": multisine(0.5)}
    assert from_arrays(arrays, **stated).runs[0].hold == "linear"
    with pytest.raises(Unusable, match="linear or zoh") as refused:
        from_arrays(arrays, hold="band-limited", **stated)
    assert refused.value.code == "bench-hold"

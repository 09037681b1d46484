"""Thinning keeps what a reader would see."""

from __future__ import annotations

import numpy as np
import pytest

from ident.decimation.envelope import envelope
from ident.figures import words
from ident.figures.theme import LOOKS
from ident.figures.thinning import decade_ticks, evenly_spaced, excited_band


def test_the_envelope_of_a_long_signal_keeps_a_single_spike():
    signal = np.zeros(100_000)
    signal[54_321] = 1.0
    kept = envelope(signal, 300)
    assert 54_321 in kept
    assert len(kept) <= 602


def test_spread_frequencies_are_given_ones_evenly_apart_on_a_logarithmic_axis():
    frequency = np.arange(1, 20_000) * 0.01
    kept = frequency[evenly_spaced(frequency, 0.1, 100.0, 50, logarithmic=True)]
    assert kept[0] == pytest.approx(0.1)
    assert kept[-1] == pytest.approx(100.0)
    assert np.diff(np.log(kept))[20:].std() < 0.01


def test_the_excited_band_of_noise_up_to_80_hz_ends_at_80_hz():
    rng = np.random.default_rng(1)
    spectrum = np.fft.rfft(rng.standard_normal(4096 * 4))
    spectrum[np.fft.rfftfreq(4096 * 4, 1 / 4096) > 80] = 0
    low, high = excited_band(np.fft.irfft(spectrum) + 3.0, 4096.0)
    assert low < 1
    assert 79 < high < 80.6


def test_ticks_are_one_two_five():
    assert decade_ticks(0.5, 80) == [0.5, 1, 2, 5, 10, 20, 50]


@pytest.mark.parametrize(
    ("values", "unit", "factor", "printed"),
    [
        ([2.592e-6], "m^4/s", 1e6, "1e-6 m^4/s"),
        ([3.6e-3], "s", 1e3, "ms"),
        ([3200.0], "N*s/m", 1.0, "N·s/m"),
        ([2e-5], "m", 1e6, "µm"),
        ([0.0], "m", 1.0, "m"),
    ],
)
def test_engineering_units_keep_numbers_readable(values, unit, factor, printed):
    assert words.engineering(values, unit) == (pytest.approx(factor), printed)


def luminance(colour: str) -> float:
    parts = [int(colour[place : place + 2], 16) / 255 for place in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.03928 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    light, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("look", LOOKS.values(), ids=LOOKS.keys())
def test_text_and_the_first_series_stand_out_from_the_ground(look):
    assert contrast(look.ink, look.ground) > 7
    assert contrast(look.faint, look.ground) > 4.5
    assert all(contrast(colour, look.ground) > 3 for colour in look.series[:3])

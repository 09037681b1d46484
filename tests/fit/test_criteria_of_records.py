"""Each number about what excites a machine decides a case that lies within a third of it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from ident.fit import reduction
from ident.fit.reduction import excited_band
from ident.noise.power_density import power_density
from ident.run import Run

RATE = 1000.0


def edge(command: np.ndarray) -> float:
    """The edge of the band of a command, Hz."""
    return excited_band([Run("r", "", RATE, {"command": command, "displacement": command}, {})]) / (2 * np.pi)


@pytest.mark.parametrize(("share", "ends"), [(0.9915, 50.0), (0.9885, 200.0)])
def test_the_band_holds_all_but_a_hundredth_of_the_power_and_a_quarter_more(share, ends):
    """Of two sines of 50 and of 200 Hz."""
    t = np.arange(40_000) / RATE
    command = np.sqrt(share) * np.sin(2 * np.pi * 50 * t) + np.sqrt(1 - share) * np.sin(2 * np.pi * 200 * t)
    assert edge(command) == pytest.approx(1.25 * ends, rel=0.02)


def test_the_widest_band_is_nine_tenths_of_the_nyquist_frequency():
    assert edge(np.random.default_rng(0).standard_normal(4000)) == pytest.approx(0.9 * RATE / 2)


@pytest.mark.parametrize(("samples", "window"), [(100, 100), (600, 256), (4000, 1000), (100_000, 16_384)])
def test_the_spectrum_of_a_command_is_that_of_a_quarter_of_it_between_256_and_16384(monkeypatch, samples, window):
    asked: list[int] = []

    def known(command: np.ndarray, rate: float, segment: int) -> Any:
        asked.append(segment)
        return power_density(command, rate, segment)

    monkeypatch.setattr(reduction, "power_density", known)
    edge(np.random.default_rng(0).standard_normal(samples))
    assert asked == [window]

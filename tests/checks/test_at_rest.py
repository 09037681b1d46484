"""Stretches in which inputs rest are found without looking at every sample of those that never do."""

from __future__ import annotations

import numpy as np
import pytest

from ident.checks.at_rest import HELD, held, spans


def signals(rng: np.random.Generator) -> list[np.ndarray]:
    """Noise, steps, noise that rests now and then, a slow sine, and one that does not move."""
    n = 3000
    noise = rng.standard_normal(n)
    rare = noise.copy()
    for begin in rng.integers(0, n - 60, 4):
        rare[begin : begin + int(rng.integers(5, 60))] = 0.3
    steps = np.repeat(rng.standard_normal(n // 25), 25)
    return [noise, steps, rare, np.sin(np.arange(n) / 400), np.ones(n)]


@pytest.mark.parametrize("samples", [1, 2, 3, 7, 8, 9, 24, 40, 57, 400])
def test_a_quick_look_misses_no_stretch(samples):
    rng = np.random.default_rng(samples)
    for signal in signals(rng):
        expected = spans(signal, samples) <= HELD * np.ptp(signal)
        assert np.array_equal(held([signal], samples), expected)

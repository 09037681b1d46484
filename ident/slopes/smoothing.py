"""The slope of a signal that was read with noise: a line through as many samples as still follow it.

    y'[k] = Σ j y[k+j] / Σ j²,    j = −m … m        (Savitzky and Golay 1964)

Its noise has the variance σ² / Σ j²: a difference over two samples (m = 1) hides what a line over twenty shows. The
data say how wide the line may be: m grows while the slope differs from those of all narrower lines by no more than
their noise (Lepski 1991). A signal without noise keeps m = 1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ident.resolution import noise_of

Array = NDArray[np.float64]
WIDTHS = (1, 2, 3, 4, 6, 8, 11, 16, 23, 32)
"""[samples] Half-widths m that are tried: steps of a third, as each takes a third of the noise away."""
MATTERS = 0.01
"""[of the slope's standard deviation] Noise of the central difference below which nothing is smoothed.

Why: a hundredth is what an effect has to take of what could be explained.
Test: tests/test_slopes.py::test_a_slope_of_a_noisy_position_is_nearer_to_the_speed"""
MOST_NOISE = 0.1
"""[of the signal's standard deviation] Why: a signal that is rougher moves so, and is not read with noise.

Test: tests/test_slopes.py::test_of_noise_and_of_a_sine_the_slope_is_that_over_two_samples"""
AGREES = 1.15
"""[standard deviations] By which two slopes may differ, of the narrower line's noise. Why: that makes most of it.

Test: tests/test_slopes.py::test_a_slope_is_smoothed_no_wider_than_it_bends"""


def smoothed_slope(signal: Array) -> Array | None:
    """The slope per sample of a signal (n,); None where its noise does not matter and differences serve."""
    if len(signal) <= 4 * WIDTHS[-1]:
        return None
    sigma, central = noise_of(signal), np.gradient(signal)
    if sigma / np.sqrt(2.0) <= MATTERS * np.std(central) or sigma > MOST_NOISE * np.std(signal):
        return None
    tried: list[tuple[float, Array]] = []
    for m in WIDTHS:
        j = np.arange(-m, m + 1)
        slope = np.convolve(np.pad(signal, m, "edge"), -j / np.sum(j**2), "valid")
        inside = slice(WIDTHS[-1], -WIDTHS[-1])
        if any(np.sqrt(np.mean((slope - narrower)[inside] ** 2)) > AGREES * noise for noise, narrower in tried):
            break
        tried.append((sigma / float(np.sqrt(np.sum(j**2))), slope))
    if len(tried) == 1:
        return None
    m, found = WIDTHS[len(tried) - 1], tried[-1][1]
    for end in (slice(None), slice(None, None, -1)):  # lines that reach beyond an end: a cubic through the last ones
        of_end = signal[end][: 4 * m + 1]
        line = np.polynomial.Polynomial.fit(np.arange(len(of_end)), of_end, 3).deriv()
        found[end][:m] = line(np.arange(m)) * (1.0 if end.step is None else -1.0)
    return found

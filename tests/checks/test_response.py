"""The rough response of a check, against SciPy's averages over the same frames."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.signal

from ident.checks.response import FRAMES, SHORTEST_FRAME, response

RATE = 250.0


@pytest.mark.parametrize("samples", [200, 4097, 60_000])
def test_powers_and_coherence_are_those_of_welch(samples: int) -> None:
    rng = np.random.default_rng(samples)
    u = np.cumsum(rng.standard_normal(samples))
    y = np.convolve(u, [0.2, 0.5, 0.1])[:samples] + rng.standard_normal(samples)
    found = response(u, y, RATE)
    assert found is not None
    length = 2 * len(found.frequency)
    options = {"fs": RATE, "nperseg": length, "detrend": "constant"}
    assert found.frames >= FRAMES - 1
    frequency, coherence = scipy.signal.coherence(u, y, **options)
    assert found.frequency == pytest.approx(frequency[1:])
    assert found.coherence == pytest.approx(coherence[1:], rel=1e-9)
    gain = scipy.signal.csd(u, y, **options)[1] / scipy.signal.welch(u, **options)[1]
    assert np.abs(found.gain - gain[1:]).max() < 1e-9 * np.abs(gain).max()


def test_a_short_record_has_none() -> None:
    assert response(np.ones(SHORTEST_FRAME), np.ones(SHORTEST_FRAME), RATE) is None

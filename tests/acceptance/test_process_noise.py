"""An integrator with process noise: the gain's standard error is right over windows, and wrong over whole runs.

Seeds 100 to 199 in the long form, the first twelve of them in the short one, for the windows alone.
"""

from __future__ import annotations

import numpy as np
import pytest

from ident.fit import identification
from ident.fit.settings import Settings
from ident.workflows import identify
from tests.fit.test_windows import GAIN, cylinder

SETTINGS = Settings(model="motor", options={"population": 24, "generations": 6, "elite": 3})


def deviations(seeds: range) -> np.ndarray:
    """How far the gain is off, in its own standard errors, for each seed."""
    found = []
    for seed in seeds:
        matrix = cylinder(seed, wander=1e-3, seconds=90.0, uses=("fit",))
        fit = identify(matrix, SETTINGS)
        gain = next(known for known in fit.determined if known.expression == "Kt / c0")
        found.append((gain.value - GAIN) / gain.std_error)
    return np.array(found)


def test_the_gain_lies_within_its_standard_errors_as_often_as_it_should(full):
    z = deviations(range(100, 200 if full else 112))
    assert abs(z.mean()) < 1.0
    covered = float(np.mean(np.abs(z) < 1.96))
    assert (0.90 if full else 0.75) <= covered <= (0.98 if full else 1.0)


@pytest.mark.full
def test_over_whole_runs_it_does_not(monkeypatch):
    monkeypatch.setattr(identification, "in_windows", lambda optimum, *_, **__: optimum)
    z = deviations(range(100, 200))
    assert np.mean(np.abs(z) < 1.96) < 0.7

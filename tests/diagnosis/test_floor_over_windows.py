"""The noise floor over windows: what a repeated run shows of a disturbance counts from where each window begins."""

from __future__ import annotations

import numpy as np
import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run

RATE, COUNT, HORIZON, STEP = 100.0, 6000, 0.2, 0.02


def pushed(seed: int) -> Run:
    """A motor that integrates its held command, by a sum, under a disturbance that is a random walk of a known step."""
    command = np.repeat(np.random.default_rng(11).choice([-1.0, 1.0], COUNT // 30), 30)
    walk = np.cumsum(STEP * np.random.default_rng(seed).standard_normal(COUNT))
    moved = np.cumsum(command) / RATE + walk
    channels, units = {"command": command, "displacement": moved}, {"command": "V", "displacement": "rad"}
    return Run(f"r{seed}", "", RATE, channels, units, hold="zoh")


def test_a_slow_disturbance_is_little_noise_over_windows():
    """The mean square of a walk over the k-th sample of a window is k times that of its step."""
    matrix = Matrix(Actuator("MOTOR"), (pushed(1), pushed(2)))
    models = CandidateModels.of(matrix, Settings(model="motor"), (), HORIZON, None)
    assert models.floors.measured
    samples = round(HORIZON * RATE)
    expected = STEP * np.sqrt((samples - 1) / 2.0)
    sizes = [np.std(run.measured) for run in matrix.runs]
    found = [models.floors.by_run[run.id] * size for run, size in zip(matrix.runs, sizes, strict=True)]
    assert np.exp(np.mean(np.log(found))) == pytest.approx(expected, rel=0.15)
    whole = CandidateModels.of(matrix, Settings(model="motor"), ()).floors
    assert min(whole.by_run.values()) > 3.0 * max(models.floors.by_run.values())

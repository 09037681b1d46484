"""Trials of long records are made on parts of them that show what the whole records show."""

from __future__ import annotations

import numpy as np
import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.screening import predict
from ident.diagnosis.trial_records import TrialRecords
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from tests.diagnosis.vary import vary

RATE, COUNT, STEPS = 200.0, 6000, 4
MASS, DAMPING, SPRING, STOP, STOP_STIFFNESS = 2.0, 20.0, 400.0, 0.012, 2e5


def noise_run(name: str, samples: int) -> Run:
    command = np.random.default_rng(3).standard_normal(samples)
    channels = {"command": command, "displacement": np.cumsum(command)}
    return Run(name, "", 100.0, channels, {"command": "N", "displacement": "m"}, kind="blwn")


@pytest.mark.parametrize(("ratio", "is_whole"), [(1.4, False), (1.6, True)])
def test_a_run_whose_residual_comes_late_is_tried_whole(ratio, is_whole):
    runs = noise_run("steady", 40_000), noise_run("late", 40_000)
    steady, late = np.ones(40_000), np.ones(40_000)
    late[30_000:] = np.sqrt(1.0 + 4.0 * (ratio - 1.0))  # a quarter of the samples
    records = TrialRecords(runs, 50.0).representing([steady, late])
    first, second = records.of(CRITERIA.estimation.rough_samples)
    assert first.length < 40_000
    assert (second.length == 40_000) is is_whole
    assert records.representing([steady, steady]) is records


def stopped(seed: int) -> Run:
    """m x'' + c x' + k x = u, and a stop at 12 mm that the force reaches in the last quarter alone, by Euler's method.

    The method is Euler's of second order, symplectic: independent of the program's, with a quarter of its step.
    """
    rng = np.random.default_rng([5, seed])
    force = np.convolve(rng.standard_normal(COUNT + 20), np.ones(20) / 20.0, "valid")[:COUNT] * 9.0
    force[: 3 * COUNT // 4] *= 0.4
    x = v = 0.0
    shown = np.empty(COUNT)
    for i in range(COUNT):
        shown[i] = x
        for _ in range(STEPS):
            beyond = max(abs(x) - STOP, 0.0) * np.sign(x)
            v += (force[i] - DAMPING * v - SPRING * x - STOP_STIFFNESS * beyond) / MASS / (STEPS * RATE)
            x += v / (STEPS * RATE)
    shown += 0.002 * np.std(shown) * rng.standard_normal(COUNT)
    channels, units = {"command": force, "displacement": shown}, {"command": "N", "displacement": "m"}
    return Run(f"run-{seed}", "", RATE, channels, units, kind="blwn", hold="zoh")


def test_a_stop_that_is_hit_after_the_first_part_of_the_records_is_predicted(monkeypatch):
    vary(monkeypatch, "estimation", rough_samples=3_000)
    matrix = Matrix(Actuator("LATE"), (stopped(1), stopped(2)))
    models = CandidateModels.of(matrix, Settings(model="drive"))
    base = models.refit((), {"m0": MASS, "c0": DAMPING, "k0": SPRING})
    (unseen,) = predict(models, base, ["end_stop"])
    (seen,) = predict(models.representing(base), base, ["end_stop"])
    assert unseen.remaining > 0.99
    assert seen.remaining < 0.6

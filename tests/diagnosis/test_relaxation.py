"""A rubber element that is moved, from equations of its own: its relaxation is named, and no friction stands for it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.screening import predict
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import rank_only
from tests.short_form import short_form

RATE, NOISE, STIFFNESS = 100.0, 0.01, 2e5
FEW = ("relaxation", "presliding_friction", "specimen_hysteresis", "coulomb_friction", "quadratic_damping")


def rubber(seed: int, time: float, share: float) -> Run:
    """Zener's solid: a spring, and one that relaxes in parallel (Maxwell), moved by sines of 0.1 to 3 Hz, by SciPy."""
    rng, t = np.random.default_rng([5, seed]), np.arange(round(15.0 * RATE)) / RATE
    fine = np.arange(20 * len(t)) / (20 * RATE)
    x = sum(np.sin(2 * np.pi * f * fine + rng.uniform(0, 6.28)) for f in np.linspace(0.1, 3.0, 12)) * 4e-4
    _, crept, _ = scipy.signal.lsim(([1.0], [time, 1.0]), x - x[0], fine)
    force = STIFFNESS * (x + share * (x - x[0] - crept))[::20]
    noisy = force + NOISE * np.std(force) * rng.standard_normal(len(t))
    channels, units = {"displacement": x[::20], "force": noisy}, {"displacement": "m", "force": "N"}
    return Run(f"run-{seed}", "", RATE, channels, units, output="force", use="verify" if seed else "fit")


@pytest.mark.full
@pytest.mark.parametrize(("time", "share"), [(0.5, 0.4), (0.03, 0.5)])
def test_a_force_that_relaxes_is_named_with_its_stiffness_and_its_time(monkeypatch, time, share):
    rank_only(monkeypatch, FEW)
    records = Matrix(Actuator("RUBBER"), (rubber(0, time, share), rubber(1, time, share)))
    found = diagnose(records, identify(records, model="specimen"), propose=False)
    assert found.verdict.effects == ("relaxation",)
    values = found.ladder[-1].parameters
    assert values["relaxation.time"].value == pytest.approx(time, rel=0.1)
    assert values["relaxation.stiffness"].value == pytest.approx(share * STIFFNESS, rel=0.1)
    assert found.ladder[-1].error["verify"] < 1.1 * NOISE


@pytest.mark.parametrize("slower", short_form([1.0, 1e3, 3e4], 1e3))
def test_of_a_slow_record_as_much_is_predicted_of_what_relaxes_as_of_a_quick_one(slower):
    """By its usual time of a tenth of a second it ran away in a record of hours, and nothing was predicted of it."""
    quick = rubber(0, 0.5, 0.4)
    records = Matrix(Actuator("RUBBER"), (replace(quick, sample_rate=quick.sample_rate / slower),))
    models = CandidateModels.of(records, Settings(model="specimen"))
    base = models.refit((), identify(records, Settings(model="specimen", seed=1)).values)
    predicted = predict(models, base, list(models.effects))
    assert min(predicted, key=lambda one: one.after.error).effect == "relaxation"
    assert min(one.remaining for one in predicted) < 0.2

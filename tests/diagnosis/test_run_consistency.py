"""Runs that ask for different parameters: an inertia with viscous friction, solved exactly, another in each run."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.diagnosis.budget import SearchBudget
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.challenges import run_sentences
from ident.diagnosis.run_consistency import inconsistent_parameters
from ident.diagnosis.sentences import inconsistent_sentence
from ident.diagnosis.stages import Stages
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from tests.diagnosis.vary import vary

RATE, INERTIA, FRICTION = 100.0, 2e-3, 1e-2


def turned(number: int, inertia: float, seed: int) -> Run:
    """Held torques into J ω' + c ω = M, with 1 % of coloured noise on ω."""
    rng = np.random.default_rng([seed, number])
    torque = np.repeat(rng.uniform(-0.1, 0.1, 20), 25)
    held = np.exp(-FRICTION / inertia / RATE)
    speed = np.zeros(len(torque))
    for k in range(1, len(speed)):
        speed[k] = held * speed[k - 1] + (1 - held) * torque[k - 1] / FRICTION
    noise = np.convolve(rng.standard_normal(len(speed) + 4), np.ones(5) / np.sqrt(5), mode="valid")
    channels = {"command": torque, "velocity": speed + 0.01 * speed.std() * noise}
    units = {"command": "N*m", "velocity": "rad/s"}
    return Run(f"run {number}", "", RATE, channels, units, output="velocity", hold="zoh")


def fitted(*inertias: float, seed: int = 1):
    """The models of runs of machines with these inertias, and the one that is fitted to all of them."""
    runs = tuple(turned(number, inertia, seed) for number, inertia in enumerate(inertias))
    models = CandidateModels.of(Matrix(Actuator("D"), runs), Settings(model="drive"), ())
    return models, models.refit((), {"m0": INERTIA, "c0": FRICTION})


def found(*inertias: float, seed: int = 1):
    """The parameters in which runs of machines with these inertias disagree."""
    return inconsistent_parameters(*fitted(*inertias, seed=seed))


def test_runs_of_one_machine_agree(full):
    """Seeds 1 to 12, in the short form to 4, three runs each; a run by itself has none to agree with."""
    assert not any(found(INERTIA, INERTIA, INERTIA, seed=seed) for seed in range(1, 13 if full else 5))
    assert not found(INERTIA)


def test_a_machine_that_differs_by_little_is_one_machine():
    assert not found(INERTIA, 1.15 * INERTIA)


def test_runs_of_two_machines_disagree_in_what_differs():
    (inertia,) = found(INERTIA, 1.8 * INERTIA)
    assert (inertia.name, inertia.unit) == ("m0", "kg*m^2")
    assert (inertia.least, inertia.most) == pytest.approx((INERTIA, 1.8 * INERTIA), rel=0.03)


def test_the_sentence_says_what_to_record():
    (text,) = inconsistent_sentence(found(INERTIA, 1.8 * INERTIA), moved=False)
    assert "m0 from 0.00" in text
    assert "determine no value of m0." in text
    assert "Record the torque" in text
    (of_specimen,) = inconsistent_sentence(found(INERTIA, 1.8 * INERTIA), moved=True)
    assert "Repeat one run" in of_specimen
    assert not list(inconsistent_sentence((), moved=False))


def test_a_diagnosis_says_it_of_the_selected_model():
    """By the stage of a diagnosis: the drive of this machine is doubted, since a torque is commanded."""
    models, refit = fitted(INERTIA, 1.8 * INERTIA)
    selection: Any = SimpleNamespace(models=models, fitted=refit)
    budget = SearchBudget(most=1)
    (text,) = run_sentences(selection, Stages(budget), budget)
    assert "determine no value of m0." in text
    assert "did not give what was commanded" in text


def test_of_many_runs_none_is_fitted_alone(monkeypatch):
    vary(monkeypatch, "consistency", most_runs=2)
    assert found(INERTIA, 1.8 * INERTIA)
    assert not found(INERTIA, 1.8 * INERTIA, INERTIA)

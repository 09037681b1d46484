"""Runs whose label is doubted are simulated as they were fitted."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.label_checks import _errors
from ident.fit.settings import Settings
from tests.blind.machines import Machine
from tests.reference import qian_reference as linear

PLANT = linear.Plant()


def test_a_run_as_it_is_labelled_leaves_the_error_of_the_fit():
    """Also of a valve whose time constant is an eighth of a sample: steps that are too long would run away."""
    matrix = Machine(PLANT, {}, 0.0, small=True, seed=31).measured(every=8)
    models = CandidateModels.of(matrix, Settings())
    fitness = models.fitness(())
    values = {
        "Z0": PLANT.Z0,
        "tau": 0.125 / matrix.runs[0].sample_rate,
        "Cl": PLANT.Cl,
        "c0": PLANT.c0,
        "m0": PLANT.m0,
        "Ka": PLANT.Ka,
    }
    run = matrix.of_use("fit")[0]
    left = run.measured - fitness.outputs_at(values)[run.id]
    expected = np.std(left) / np.std(run.measured)
    assert expected < 1
    fitted = SimpleNamespace(fitness=fitness, values=values)
    assert _errors(models, fitted, run, {})[0] == pytest.approx(expected, rel=1e-6)

"""What the data do not determine rests where few steps follow the model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.resting import Resting
from ident.diagnosis.undetermined import rested
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from tests.reference.periodic_reference import Law, driven


def drive(m: float) -> CandidateModels:
    """A mass on a spring in oil, moved by a slow sine of force, with 5 % noise; seed 6."""
    rate = 100.0
    force = 5.0 * np.sin(2 * np.pi * 0.5 * np.arange(1500) / rate)
    x = driven(Law(m=m, c=1.4, k=3.7), force, rate, "linear", 64, "displacement")
    x = x + 0.05 * np.std(x) * np.random.default_rng(6).standard_normal(len(x))
    run = Run("a", "", rate, {"drive_force": force, "displacement": x}, hold="linear")
    return CandidateModels.of(Matrix(Actuator("A"), (run,)), Settings(model="drive"))


def steps(models: CandidateModels, refit) -> int:
    fitness = models.fitness(refit.effects)
    return int(fitness.steps(fitness.space.values(refit.point[None]))[0])


def test_a_mass_that_no_record_shows_rests_where_steps_are_few():
    models = drive(m=1e-4)
    found = models.refit((), {"m0": 5e-4, "c0": 1.4, "k0": 3.7})
    assert steps(models, found) == 32
    _, moved = rested(models, found)
    assert steps(models, moved) <= 4
    assert moved.error <= (1 + 2e-4) * found.error


def test_a_mass_that_the_record_shows_stays():
    models = drive(m=0.14)
    found = models.converged(models.refit((), {"m0": 0.1, "c0": 1.4, "k0": 3.7}))
    _, stays = rested(models, found)
    assert stays is found


def resting() -> tuple[CandidateModels, CandidateModels, FittedModel]:
    """A mass that no record shows: models that are free, models with it at rest, and where it rests."""
    free = drive(m=1e-4)
    models, base = rested(free, free.refit((), {"m0": 5e-4, "c0": 1.4, "k0": 3.7}))
    return free, models, base


def test_what_rests_stays_where_it_is_with_effects():
    """From a start that has it elsewhere, too; free, a step along what is flat leads it astray."""
    free, models, base = resting()
    start = {**base.values, "m0": 5e-4}
    for refit in (models.trial(("coulomb_friction",), [start]), models.refit(("coulomb_friction",), start)):
        assert steps(models, refit) <= 4
        assert refit.values["m0"] == pytest.approx(base.values["m0"], rel=0.2)
    assert steps(models, free.refit(("coulomb_friction",), start)) > 4


def test_what_rests_is_free_where_a_model_asks_for_another_place():
    """Of a record that shows the mass, with it held far too small: the error promises to fall."""
    shown = drive(m=0.14)
    found = shown.converged(shown.refit((), {"m0": 0.1, "c0": 1.4, "k0": 3.7}))
    axis, place = found.space.names.index("m0"), found.space.point({**found.values, "m0": 0.05})
    held = replace(shown, resting=Resting({"m0": float(place[axis])}))
    assert held.refit((), found.values).values["m0"] == pytest.approx(found.values["m0"], rel=0.01)

"""A fit with effects: cut anywhere it ends the same, one bad run does not spoil it, and it takes effects of users."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from app.regress.recheck import on_the_same_runs
from ident.effects.effect import Effect
from ident.fit.identification import Identification
from ident.fit.settings import Settings
from ident.fit.simulated_fitness import SimulatedFitness
from ident.fit.space import search_space
from ident.matrix import Matrix
from ident.parameter import Parameter
from ident.presets import PRESETS
from ident.run import Specimen
from ident.workflows import compare, identify
from tests.fit.recovery import NOISE, matrix

SETTINGS = Settings(effects=("dead_zone",), seed=4)


@pytest.fixture(scope="module")
def data() -> Matrix:
    """A third of the paper's matrix, half a second a run, with a dead zone of 0.2 mm."""
    return matrix("dead_zone", 2e-4, seed=5, seconds=0.5, every=3)


@pytest.mark.full
def test_a_search_cut_after_every_generation_ends_the_same(data):
    """Each generation in a new process, the state through JSON: the same parameters, bit for bit."""
    whole = identify(data, SETTINGS)
    state = Identification(data, SETTINGS).start()
    while not Identification(data, SETTINGS).finished(state):
        state = json.loads(json.dumps(Identification(data, SETTINGS).advance(state, 1)))
    assert Identification(data, SETTINGS).finish(state).values == whole.values


def test_one_bad_run_is_named_and_left_out(data):
    """A run with a wrong stiffness on its label: the others are fitted as if it were not there."""
    wrong = data.runs[5]
    changed = replace(wrong, specimen=Specimen(wrong.specimen.mass, wrong.specimen.stiffness + 60e3))
    runs = tuple(changed if run is wrong else run for run in data.runs)
    matrix = replace(data, runs=runs)
    found = identify(matrix, SETTINGS)
    assert any(wrong.id in note and "left out" in note for note in found.notes)
    assert {run.id: run.error for run in found.runs}[wrong.id] > 5 * NOISE
    assert found.left_out == (wrong.id,)
    others = [run.error for run in found.runs if run.use == "fit" and run.id != wrong.id]
    assert found.error["fit"] == pytest.approx(np.mean(others))
    assert compare(matrix, found).error["fit"] == pytest.approx(found.error["fit"], rel=1e-3)
    earlier = replace(found, left_out=(), error={"fit": float(np.mean([*others, found.runs[5].error]))})
    assert on_the_same_runs(found, found, matrix) == (found.error, found.error_with_mean)
    assert on_the_same_runs(found, earlier, matrix)[0]["fit"] == pytest.approx(earlier.error["fit"], rel=1e-3)
    assert found.values["dead_zone.half_width"] == pytest.approx(2e-4, rel=0.01)


def test_an_unstable_vector_costs_and_is_counted(data):
    """A vector with ten times the gain is no failure; errors of a population with it are finite."""
    work = Identification(data, Settings(effects=("dead_zone",), bounds={"Z0": (1e-6, 1e-4)}))
    points = np.full((4, len(work.objective.space.names)), 0.3)
    points[0, 0] = 1.0
    errors = work.searched.errors(points)
    assert errors[0] == 1e3
    assert np.all(errors[1:] < 1e3)
    assert work.searched.unstable == 1
    assert not np.isfinite(work.objective.exact(points[0]).error)


def test_an_effect_defined_here_is_fitted(data):
    """The dead zone again, under another name and in other words, without touching anything else."""
    own = Effect(
        name="overlap",
        place="spool",
        meaning="the lands overlap",
        strength=Parameter("width", "b", "m", 0.0, 1e-3, 0.0, "half of the overlap"),
        texts=("w = where(abs(w) < b, 0, w - b * sgn(w))",),
    )
    model = PRESETS["qian2014"].with_effects((own,))
    space = search_space(model, data, Settings(), 500.0)
    fitness = SimulatedFitness(model, data, data.of_use("fit"), 500.0, space)
    start = space.point({p.in_equations: p.value for p in model.parameters} | {"overlap__width": 1e-4})
    point, here = fitness.optimum(start)
    assert float(space.values(point[None])["overlap__width"][0]) == pytest.approx(2e-4, rel=0.01)
    assert np.mean([run.error for run in here.runs]) < 1.05 * NOISE

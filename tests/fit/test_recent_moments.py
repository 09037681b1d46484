"""What a diagnosis asked for a short while ago is not simulated again, and what is asked anew is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.fit import recent_moments
from ident.fit.recent_moments import RecentMoments
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.simulation.simulate import Simulation

POINT = np.array([0.5, 0.4, 0.3])


def models(begins: str) -> CandidateModels:
    """Of a motor and a record of noise, which any model leaves much of."""
    rng = np.random.default_rng(5)
    channels = {name: np.cumsum(rng.standard_normal(200)) for name in ("command", "velocity")}
    units = {"command": "V", "velocity": "rad/s"}
    run = Run("r", "", 100.0, channels, units, output="velocity", assumed_beginning=begins)
    return CandidateModels.of(Matrix(Actuator("S"), (run,)), Settings(model="motor"))


@pytest.fixture
def simulated(monkeypatch) -> list[int]:
    """A number for each simulation that begins."""
    begun, outputs = [], Simulation.outputs

    def counting(simulation, *asked):
        begun.append(simulation.shape[1])
        return outputs(simulation, *asked)

    monkeypatch.setattr(Simulation, "outputs", counting)
    return begun


@pytest.mark.parametrize("begins", ["at rest", "standing"])
def test_the_same_is_simulated_once_on_trial_and_on_every_sample(begins, simulated):
    """A record that is not shortened for a trial is the same record; the answer is the same to the bit."""
    of = models(begins)
    point = POINT[: len(of.fitness(("coulomb_friction",)).space.axes)]
    first = of.fitness(("coulomb_friction",), 131_072).exact(point)
    assert len(simulated) == 1
    again = of.fitness(("coulomb_friction",)).exact(point)
    assert len(simulated) == 1
    alone = replace(of.fitness(("coulomb_friction",)), recent=None).exact(point)
    assert len(simulated) == 2
    for other in (again, alone):
        assert other.error == first.error
        assert np.array_equal(other.gradient, first.gradient)
        assert np.array_equal(other.curvature, first.curvature)


@pytest.mark.parametrize("what", ["values", "effects", "windows", "runs"])
def test_what_differs_in_anything_is_simulated(what, simulated):
    of = models("at rest")
    fitness = of.fitness(("coulomb_friction",))
    point = POINT[: len(fitness.space.axes)]
    fitness.exact(point)
    before = len(simulated)
    match what:
        case "values":
            fitness.exact(point + 1e-12)
        case "effects":
            of.fitness(("dead_zone",)).exact(point)
        case "windows":
            replace(fitness, horizon=0.3).exact(point)
        case _:
            fitness.fresh((fitness.runs[0].part(0, 150),)).exact(point)
    assert len(simulated) > before


def test_another_first_state_is_another_simulation():
    """Of a record that begins in motion the same values leave something else from another state."""
    fitness = models("moving").fitness(("coulomb_friction",))
    point = POINT[: len(fitness.space.axes)]
    near, far = fitness.fresh(fitness.runs), fitness.fresh(fitness.runs)
    first = near.exact(point, worth=lambda _promised: False)
    far.starts = {run: start + 3.0 for run, start in near.starts.items()}
    there = far.exact(point, worth=lambda _promised: False)
    assert there.runs[0].power != first.runs[0].power


def test_only_so_many_are_kept(monkeypatch):
    """The one that was asked for longest ago is let go."""
    monkeypatch.setattr(recent_moments, "_MOST", 4)
    kept, made = RecentMoments(), []

    def found(asked: str) -> tuple[int, dict[str, str]]:
        made.append(asked)
        return 1, {"one": asked, "two": asked}

    for asked in ("a", "b", "a", "c", "a", "b"):
        assert kept.of(asked, lambda asked=asked: found(asked)) == (1, {"one": asked, "two": asked})
    assert made == ["a", "b", "c", "b"]

"""What a diagnosis asked for a short while ago is not simulated again, and what is asked anew is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.fit import recent_moments, simulated_runs
from ident.fit.normal_matrices import NormalMatrices
from ident.fit.recent_moments import RecentMoments
from ident.fit.settings import Settings
from ident.fit.simulated_runs import SimulatedRuns
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


def test_what_a_refit_leaves_on_trial_is_simulated_once(simulated):
    """A ranking asks for it as the target of its trials, of its finalists and of its starts from elsewhere."""
    of = models("at rest")
    refit = of.refit(("coulomb_friction",), of.fitness(("coulomb_friction",)).space.typical)
    before, asked = len(simulated), of.trial_error(refit)
    assert of.trial_error(refit) == asked
    assert len(simulated) == before + 1
    assert of.over_windows(0.3, None).trial_error(refit) != asked


def test_first_states_are_followed_from_what_was_simulated(monkeypatch):
    """What the first states promise is known where it is decided that they are followed."""
    fitness = models("moving").fitness(("coulomb_friction",))
    rounds, settled, each = [], SimulatedRuns.settled, SimulatedRuns._normal_matrices

    def following(runs, values, strides, *asked, **known):
        rounds.append([])
        return settled(runs, values, strides, *asked, **known)

    def simulating(*asked):
        rounds[-1].append(asked[3])
        return each(*asked)

    def at_once(own, run, settling, found):
        settling.step(run.id, own.start(run), found)
        return False

    monkeypatch.setattr(SimulatedRuns, "settled", following)
    monkeypatch.setattr(SimulatedRuns, "_normal_matrices", simulating)
    monkeypatch.setattr(SimulatedRuns, "goes_on", at_once)
    monkeypatch.setattr(NormalMatrices, "promises", property(lambda _found: True))
    fitness.exact(POINT[: len(fitness.space.axes)])
    assert [len(of) for of in rounds] == [1, 0]


def test_what_is_known_leads_to_the_same_first_states_as_a_simulation_of_it():
    """To the bit: rounding chooses among optima of a record in which friction sticks and slips."""
    fitness, starts = models("moving").fitness(("coulomb_friction",)), []
    values = fitness.space.values(np.concatenate([POINT[None, : len(fitness.space.axes)]] * 3))
    values = {name: value * [1.0, 1.0001, 1.0] for name, value in values.items()}
    alone = {name: value[:1] for name, value in values.items()}
    for known in (True, False):
        runs = fitness.fresh(fitness.runs)
        runs.begin({name: float(value[0]) for name, value in values.items()})
        found = runs.settled(values, np.array([1e-4, 1e-4]), 1)
        runs.settled(alone, np.empty(0), 1, known=found if known else None)
        starts.append(runs.starts["r"])
    assert np.any(starts[0])
    assert np.array_equal(*starts)


def test_steps_are_asked_for_once_where_a_record_begins_in_motion(monkeypatch):
    """For its first states and for its moments."""
    asked, fastest = [], simulated_runs.fastest
    monkeypatch.setattr(simulated_runs, "fastest", lambda *of: asked.append(0) or fastest(*of))
    fitness = models("moving").fitness(("coulomb_friction",))
    point = POINT[: len(fitness.space.axes)]
    fitness.exact(point)
    assert len(asked) == 1
    fitness.exact(0.9 * point)
    assert len(asked) == 2


def test_what_effects_begin_with_is_measured_where_a_first_state_is_moved(simulated):
    """A prediction moves none: it begins where the linear model does."""
    fitness = models("moving").fitness(("presliding_friction",))
    values = {name: float(value[0]) for name, value in fitness.space.values(np.full((1, 8), 0.5)).items()}
    fitness.begin(values)
    begun = len(simulated)
    assert np.all(fitness.sizes_of_effects == 0.0)
    _ = fitness._reach
    assert len(simulated) == begun + 1
    assert np.all(fitness.sizes_of_effects > 0.0)


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

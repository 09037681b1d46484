"""What a refit says is what a simulation leaves, also of runs that begin in motion."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from ident.diagnosis.budget import SearchBudget
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.diagnose import Diagnoser
from ident.diagnosis.discovery.search import TermSearch
from ident.diagnosis.evidence.comparison import Residuals
from ident.diagnosis.evidence.energy_bands import EnergyBands, Record
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.report import _ladder
from ident.fit.levenberg_marquardt import Way, promise

MEASURED = np.sin(np.arange(1000) / 50.0)


def refit(begins: str, left: float, promised: float = 0.1) -> FittedModel:
    """A refit that promises an error on one run, and whose simulation leaves another."""
    run = SimpleNamespace(id="a", begins=begins, measured=MEASURED, share=1.0, output="displacement", units={})
    fitness = SimpleNamespace(
        runs=(run,),
        matrix=SimpleNamespace(of_use=lambda _use: (run,)),
        outputs=lambda _point: {"a": MEASURED * (1.0 - left)},
        left=lambda run, output: (run.measured - output) - (run.measured - output).mean(),
        horizon=None,
    )
    fitness.fresh = lambda _runs: fitness
    found = SimpleNamespace(error=promised, offset=0.0, share=1.0, transducer="")
    here = SimpleNamespace(error=promised, runs=(found,), curvature=np.zeros((1, 1)))
    return FittedModel((), {}, None, np.zeros(1), here, fitness, None)


@pytest.mark.parametrize(
    ("begins", "left", "finite"),
    [("moving", 0.1025, True), ("moving", 0.1035, False), ("moving", np.inf, False), ("at rest", 0.2, True)],
)
def test_what_no_first_state_leads_to_is_no_refit(begins, left, finite):
    """The correction of first states is linear: a model that is not may look good where no state leads."""
    found = refit(begins, left)
    assert found.stable
    with np.errstate(invalid="ignore"):
        assert found.finite is finite


def test_first_states_that_lead_nowhere_are_guessed_anew():
    """The search may have gone astray with them where the model keeps its promise from others."""
    found, other = refit("moving", 0.2), refit("moving", 0.1)
    found.fitness.fresh = lambda _runs: other.fitness
    assert found.finite


def test_the_error_on_runs_to_verify_is_what_a_simulation_leaves_there():
    assert refit("moving", 0.3).on_verify == pytest.approx(0.3, rel=1e-6)
    assert refit("moving", 0.3).unstable == {}


def test_a_run_to_verify_on_which_the_model_is_unstable_is_named_and_has_no_error():
    """Also where its error is a number, of a hundred digits."""
    for left in (4.52e104, np.inf):
        found = refit("at rest", left)
        with np.errstate(invalid="ignore"):
            assert found.on_verify is None
        assert found.unstable == {"verify": ("a",)}


def test_of_first_steps_the_eight_that_leave_least_go_on():
    """From where they are; what is unstable, or does not keep what it promises, makes room for the next."""
    errors, lying = [0.9, np.inf, 0.5, 0.1, 0.8, 0.2, 0.7, 0.3, 0.6, 0.4, 1.0], 0.2
    steps = [
        SimpleNamespace(
            effects=("e",),
            values={"s": error},
            local=SimpleNamespace(error=error),
            stable=np.isfinite(error),
            finite=np.isfinite(error) and error != lying,
        )
        for error in errors
    ]
    family = SimpleNamespace(continued=lambda step, way, _samples: (step.values["s"], way.aim))
    found = CandidateModels.leading(family, steps, 0.45)
    assert [aim for _, aim in found] == 8 * [0.45]
    assert [error for error, _ in found] == [error for error in sorted(errors) if error != lying][:8]


@pytest.mark.parametrize("aim", [0.05, 0.099])
def test_first_steps_that_ended_far_from_what_they_have_to_reach_are_not_begun_again(aim):
    """They are gone on with where the next step promises anything near what is missing."""
    here = SimpleNamespace(error=0.1, gradient=np.array([0.02]), curvature=np.array([[0.1]]))  # promises 0.002
    space = SimpleNamespace(spans=np.zeros(1))
    first = SimpleNamespace(effects=("e",), values={"s": 1.0}, point=np.array([0.5]), local=here, space=space)
    family = SimpleNamespace(refit=lambda *told: told)
    way = Way(aim=aim)
    assert CandidateModels.continued(family, first, way, 7) == (first if aim == 0.05 else (("e",), {"s": 1.0}, 7, way))


@pytest.mark.parametrize(("error", "aim"), [(0.1, 0.01), (0.1, 0.11), (0.1, 0.05)])
def test_first_steps_whose_next_one_is_cut_at_a_bound_are_converged_trial(error, aim):
    """What such a step promises is nothing, or less, and a shorter one may promise more."""
    curvature = np.array([[1.0, 0.99], [0.99, 1.0]])
    here = SimpleNamespace(error=error, gradient=np.array([-0.02, 0.0]), curvature=curvature)
    assert promise(here, np.array([0.05, -0.995])) < 0  # what is left within the bounds of (1.005, -0.995)
    assert not Way(aim=aim).leads_nowhere(np.array([0.95, 0.999]), here)


@pytest.mark.parametrize(("equation", "joined"), [("R = R + s * (v**3)", 3.0), ("R = R + s * (v**2)", 2.0)])
def test_a_term_that_is_added_twice_is_tried_as_one_with_both_strengths(equation, joined):
    custom = [
        {"name": "proposed_1", "equation": [equation]},
        {"name": "proposed_2", "equation": ["R = R + s * (v**3)"]},
    ]
    search = SimpleNamespace(
        base=SimpleNamespace(values={"proposed_1__s": 1.0, "proposed_2__s": 2.0}),
        models=SimpleNamespace(given=SimpleNamespace(custom=custom), strength=lambda name: f"{name}__s"),
    )
    assert TermSearch._joined(search, "proposed_2", "proposed_1")["proposed_2__s"] == joined
    assert search.base.values["proposed_2__s"] == 2.0


def test_a_rung_at_which_the_model_is_unstable_tells_no_error_and_the_next_one_no_evidence(monkeypatch):
    """What two effects make stable one of them need not; asked for its held-out error it would know none."""
    monkeypatch.setattr(FittedModel, "parameters", {})
    sound, unstable = refit("at rest", 0.1), refit("at rest", np.inf, promised=np.inf)
    noise = 0.1 * np.random.default_rng(1).standard_normal(1000)
    sound.__dict__["held_out"] = SimpleNamespace(offset=0.0, error=0.1, score=0.1)
    sound.__dict__["residuals_held_out"] = Residuals((noise,), EnergyBands((Record(1.0),), (1000,)))
    course = SearchBudget(most=4)
    diagnoser = Diagnoser(None, None, None, (), course)
    steps = [(None, sound), ("dead_zone", unstable), ("backlash", sound), ("null_bias", sound)]
    assert [rung.error["fit"] for rung in _ladder(steps, [name for name, _ in steps if name])] == [0.1, None, 0.1, 0.1]
    assert [rung.nats for rung in _ladder(steps, [name for name, _ in steps if name])] == [None, None, None, 0.0]
    diagnoser._publish_step(SimpleNamespace(ladder=lambda: steps))
    assert [one.effect for one in course.added] == ["backlash", "null_bias"]


@pytest.mark.parametrize(("at_floor", "error"), [(False, 0.2), (True, 0.3)])
def test_a_better_optimum_is_sought_unless_what_is_left_is_known_to_be_noise(at_floor, error):
    """Where no floor is known a residual may lack memory, though the model rings where the machine does not."""
    found, other = (
        SimpleNamespace(effects=(), values={}, stable=True, finite=True, local=SimpleNamespace(error=of))
        for of in (0.3, 0.2)
    )
    models = SimpleNamespace(
        is_short=lambda _refit: True,
        at_floor=lambda _refit: at_floor,
        residual_above_noise=lambda _refit: False,
        trial_error=lambda refit: refit.local.error,
        global_starts=lambda _effects: [other],
        leading=lambda starts, _aim: starts,
        refit=lambda _effects, _values: other,
        converged=lambda refit: refit,
    )
    assert CandidateModels.best_optimum(models, found).local.error == error

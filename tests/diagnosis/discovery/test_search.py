"""What no list holds: the search finds the equation itself, of machines of the independent reference."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from ident.custom.definition import read_effect
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.discovery import regression as regressions
from ident.diagnosis.discovery.candidate_terms import candidate_terms
from ident.diagnosis.discovery.run_data import run_data
from ident.diagnosis.discovery.search import TermSearch, _built
from ident.diagnosis.discovery.term import Term
from ident.diagnosis.discovery.term_candidate import TermCandidate
from ident.diagnosis.result import Diagnosis
from ident.errors import TimeIsUp, Unusable
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.progress import Progress
from ident.workflows import diagnose, identify, study
from tests.blind.machines import matrix_of
from tests.reference import qian_reference as linear
from tests.reference.outside_reference import Outside, measure_all
from tests.short_form import short_form

pytestmark = pytest.mark.usefixtures("few_effects")  # nothing of the catalogue is added here
PLANT, NOISE = linear.Plant(), 0.005
STORED = Path(__file__).parents[2] / "stored"


def machine(seed: int, count: int = 6, **hidden: float) -> Matrix:
    """So many runs of half a second to fit and three to verify; a search parts six and more."""
    trials = linear.trials()
    chosen = [trial for trial in trials if trial.use == "fit"][: 72 : 72 // count] + trials[-3:]
    return matrix_of(measure_all(Outside(**hidden), chosen, PLANT, seconds=0.5, noise=NOISE, seed=seed), PLANT)


def proposed(matrix: Matrix) -> Diagnosis:
    """The catalogue is ranked and nothing of it added: the terms are sought beside the linear model."""
    fit = identify(matrix, Settings(model="qian2014"))
    return diagnose(matrix, fit, most=0, propose=True)


@cache
def with_a_leak() -> tuple[Matrix, Diagnosis]:
    matrix = machine(1, one_way_leakage=1.2)
    return matrix, proposed(matrix)


# What the equations of tests/reference/outside_reference.py add, in the names of the chain.
TRUTHS = {
    "unequal_areas": (0.06, "Q = Q + s * (abs(v)); R = R + s * (P * sgn(v))", -0.06 * PLANT.A),
    "pressure_gain": (0.08, "w = w + s * (w * abs(P))", 0.08 / 1e6),
    "gain_drift": (0.3, "w = w + s * (t * w)", 0.3),
    "position_friction": (150.0, "Ff = Ff + s * (x**2)", 150.0 / 2e-3**2),
    "sensor_curve": (0.06, "y = y + s * (x**3)", 0.06 / 2e-3**2),
    "flow_force": (0.05, "e = e + s * (w * abs(P))", -0.05 / 1e6),
    "pump_ripple": (0.05, "Q = Q + s * (Q * sin(2 * pi * (fp * t + g)))", 0.05),
}


@pytest.mark.parametrize("kind", short_form(TRUTHS, "unequal_areas"))
def test_the_equation_that_no_list_holds_is_found(kind, full):
    strength, equation, true = TRUTHS[kind]
    found = proposed(machine(2, 12 if full else 6, **{kind: strength}))
    (term,) = found.proposals
    at, _, text = equation.partition(" = ")
    text = text.partition("s * (")[2].removesuffix(")")
    assert term.equation == equation or f"{at}: {text}" in term.alike  # of one class
    if term.equation == equation:
        found_strength = abs(term.strength) if kind == "pump_ripple" else term.strength  # half a turn is its sign
        assert found_strength == pytest.approx(true, rel=0.06 if kind == "position_friction" else 0.02)
    assert term.error["fit"] == pytest.approx(NOISE, rel=0.03)
    assert term.error["verify"] < 1.05 * NOISE
    assert term.nats > term.bar > 10


def test_a_proposal_is_no_finding():
    _, found = with_a_leak()
    assert [term.equation for term in found.proposals] == ["Q = Q + s * (abs(P))"]
    assert found.verdict.effects == ()
    assert found.verdict.unexplained
    assert found.proposals[0].effect["source"] == "proposed by search"
    assert "leakage in one direction" in found.proposals[0].meaning


def test_a_proposal_is_told_in_the_contract_s_words_and_read_again():
    _, found = with_a_leak()
    data = json.loads(json.dumps(found.to_json()))
    (term,) = data["proposals"]
    assert {
        "place",
        "equation",
        "effect",
        "terms",
        "shapes",
        "error",
        "nats",
        "bar",
        "class",
        "meaning",
        "formula",
    } <= (term.keys())
    assert term["class"] == ["w: abs(P)"]  # at the flow and at the spool it is one
    assert term["formula"].startswith("<math")
    assert Diagnosis.from_json(data).proposals == found.proposals


def test_a_proposal_is_an_effect_that_anyone_may_add():
    matrix, found = with_a_leak()
    (term,) = found.proposals
    fit = identify(matrix, Settings(model="qian2014", effects=("proposed_1",), custom=(term.effect,)))
    assert fit.error["verify"] == pytest.approx(term.error["verify"], rel=1e-3)
    assert fit.values["proposed_1.s"] == pytest.approx(term.strength, rel=1e-3)
    assert fit.values["Cl"] == pytest.approx(1.6 * PLANT.Cl, rel=0.02)  # (1 + 1.2/2) of it in both directions
    again = diagnose(matrix, fit, most=0, custom=(read_effect(term.effect, model="qian2014"),), propose=True)
    assert again.proposals == ()
    assert "the error is measurement noise" in again.notes[0]


def test_verify_runs_neither_rank_nor_choose_and_what_they_speak_against_says_so():
    """Those of the same machine before it leaked."""
    matrix, found = with_a_leak()
    other = replace(matrix, runs=(*matrix.of_use("fit"), *machine(1).of_use("verify")))
    (term,) = proposed(other).proposals
    assert term.equation == found.proposals[0].equation
    assert term.strength == found.proposals[0].strength
    assert term.error["verify"] > 5 * found.proposals[0].error["verify"]
    against = term.contradicted
    assert against.after == pytest.approx(term.error["verify"], rel=1e-3)
    assert against.before < against.after
    assert against.deviations > 2
    assert found.proposals[0].contradicted is None


@pytest.mark.full
def test_what_stood_in_for_a_term_is_left_out_again():
    """An asymmetry helps where the flow gain has a hill: with the hill it is not needed."""
    matrix = machine(2, gain_bump=0.25)
    models = CandidateModels.of(matrix, Settings(model="qian2014"))
    fit = identify(matrix, Settings(model="qian2014"))
    values = {models.preset.parameter(name).in_equations: value for name, value in fit.values.items()}
    base = models.refit(("gain_asymmetry",), {**models.off, **values})
    found = TermSearch(models, base, report=lambda _: None, given=()).run()
    (term,) = found.proposals
    assert "exp(-((x - xm) / d)**2)" in term.equation
    assert term.beside == ()
    assert term.error["fit"] == pytest.approx(NOISE, rel=0.03)
    kept = TermSearch(models, base, report=lambda _: None, given=("gain_asymmetry",)).run()  # the user's own stays
    assert kept.proposals[0].beside == ("gain_asymmetry",)


def test_the_missing_characteristic_is_there_with_the_term_through_it():
    """Flow that leaks by |P|: the residual has that curve, and the proposal predicts it."""
    matrix, found = with_a_leak()
    (term,) = found.proposals
    assert term.view == "Q(P)"
    fit = identify(matrix, Settings(model="qian2014"))
    whole = identify(matrix, Settings(model="qian2014", effects=("proposed_1",), custom=(term.effect,)))
    seen, drawn = (
        study(matrix, fit).curves(matrix.of_use("fit"), term.view, None, other)[0] for other in (None, whole)
    )
    assert seen.explained > 0.95
    x, y, other = (np.array(of) for of in (seen.x, seen.y, np.interp(seen.x, drawn.x, drawn.y)))
    visited = slice(2, -2)
    assert np.abs(y - other)[visited].max() < 0.03 * np.ptp(y)
    assert np.polyfit(np.abs(x), y, 1)[0] == pytest.approx(term.strength, rel=0.05)
    assert whole.values["proposed_1.s"] == pytest.approx(term.parameters["proposed_1.s"].value, rel=1e-3)


def test_the_strength_comes_with_its_standard_error():
    _, found = with_a_leak()
    (term,) = found.proposals
    assert 0 < term.std_error < 0.01 * abs(term.strength)
    assert abs(abs(term.strength) - 0.6 * PLANT.Cl) < 4 * term.std_error  # half of what leaks in one direction


@pytest.mark.full
@pytest.mark.parametrize("colour", ["white", "slow", "hum", "drift"])
@pytest.mark.parametrize("seed", [1, 2])
def test_noise_of_any_colour_is_no_physics(colour, seed):
    matrix = machine(seed, 12)
    runs = []
    for number, run in enumerate(matrix.runs):
        rng = np.random.default_rng([9, seed, number])
        beside = 0.02 * run.measured.std() * noise(colour, run.length, rng)
        runs.append(replace(run, channels={**run.channels, "displacement": run.measured + beside}))
    found = proposed(replace(matrix, runs=tuple(runs)))
    assert found.proposals == ()


def noise(colour: str, n: int, rng: np.random.Generator) -> np.ndarray:
    """Of unit deviation: with a memory of ten samples, of one frequency of its own phase, or a slow way."""
    if colour == "hum":
        return np.sqrt(2) * np.sin(2 * np.pi * (50.0 * np.arange(n) / linear.SAMPLE_RATE + rng.uniform()))
    if colour == "white":
        return rng.standard_normal(n)
    slow = np.zeros(n)
    share = 0.9 if colour == "slow" else 0.9999
    for k in range(1, n):
        slow[k] = share * slow[k - 1] + rng.standard_normal()
    return (slow - slow.mean()) / slow.std()


def test_a_bench_has_no_signals_inside():
    """A fit of its model is refused by its model, before its data are looked at."""
    fit = FitResult.from_json(json.loads((STORED / "bench.json").read_text(encoding="utf-8")))
    with pytest.raises(Unusable, match="no signals inside"):
        diagnose(machine(1), fit, propose=True)


def test_a_search_that_is_cut_says_so():
    matrix, _ = with_a_leak()
    fit = identify(matrix, Settings(model="qian2014"))
    steps = []

    def until_the_terms(progress: Progress) -> None:
        steps.append(progress.stage)
        if progress.stage == "proposing":
            raise TimeIsUp

    found = diagnose(matrix, fit, most=0, propose=True, report=until_the_terms)
    assert "proposing" in steps
    assert not found.complete
    assert found.proposals == ()


def test_a_model_without_a_term_has_no_bounds_of_its_shapes():
    own = {
        "name": "late",
        "place": "load",
        "equation": "R = R + s * (lag(v, T) - v)",
        "strength": {"symbol": "s", "unit": "N*s/m", "lower": -1e4, "upper": 1e4},
        "shape": {"T": {"unit": "s", "lower": 1e-4, "upper": 1e-2, "value": 1e-3}},
    }
    settings = Settings(model="qian2014", custom=(own,), bounds={"late.T": (1e-4, 1e-2)})
    models = CandidateModels.of(machine(1), settings, (read_effect(own, model="qian2014"),))
    with_it, without = (models.fitness(effects).space.axes for effects in (("late",), ()))
    assert len(with_it) == len(without) + 2


@pytest.mark.full
def test_the_regression_is_that_of_all_terms_and_runs_at_once(monkeypatch):
    """However few columns and runs are worked out together."""
    matrix, _ = with_a_leak()
    models = CandidateModels.of(matrix, Settings(model="qian2014"))
    base = models.refit((), {p.in_equations: p.value for p in models.preset.parameters})

    def candidates():
        seen = candidate_terms(models, base)
        return [(one.equation, one.strength, one.share) for one in seen.candidates]

    together = candidates()
    monkeypatch.setattr("ident.diagnosis.discovery.regressors._BATCH", 7)
    monkeypatch.setattr("ident.diagnosis.discovery.regression._RUNS_AT_ONCE", 5)
    for (text, strength, share), (other, same, left) in zip(together, candidates(), strict=True):
        assert text == other
        assert (strength, share) == pytest.approx((same, left), rel=1e-6)


@pytest.mark.full
def test_of_each_form_the_term_that_explains_most_is_set_beside_the_others(monkeypatch):
    """Where its shapes begin is all that tells a form's terms apart: the regression of every term leads to the same."""
    matrix = machine(2, gain_bump=0.25)
    models = CandidateModels.of(matrix, Settings(model="qian2014"))
    base = models.refit((), {p.in_equations: p.value for p in models.preset.parameters})
    met = []

    def regressed(terms, *of):
        met.append((terms, regression(terms, *of)))
        return met[-1][1]

    regression = regressions.regression
    monkeypatch.setattr("ident.diagnosis.discovery.candidate_terms.regression", regressed)
    seen = candidate_terms(models, base)
    monkeypatch.setattr(regressions, "_leading", lambda terms, *_: (terms, 0))
    candidate_terms(models, base)
    (listed, some), (_, every) = met
    assert (some.looked_at, every.looked_at) == (len(listed), len(listed))
    assert seen.looked_at > len(listed)
    assert len(some.terms) < min(0.7 * len(listed), 1500)
    best = {}
    for term, gain in zip(every.terms, every.gains, strict=True):
        best[term.form] = max(best.get(term.form, 0.0), gain)
    shaped = [(term.form, gain) for term, gain in zip(some.terms, some.gains, strict=True) if term.free_shapes]
    assert {form for form, _ in shaped} == {term.form for term in listed if term.free_shapes}
    assert [gain for _, gain in shaped] == pytest.approx([best[form] for form, _ in shaped], rel=1e-6, abs=1e-8)


def test_a_term_that_closes_a_circle_with_those_before_is_not_tried():
    """The resistance hangs on the flow; a spool that moved with the load's force would have no state in between."""
    given = {
        "name": "before",
        "place": "load",
        "equation": "R = R + s * Q",
        "strength": {"symbol": "s", "unit": "N*s/m^3", "lower": -1e9, "upper": 1e9},
    }
    models = CandidateModels.of(
        machine(1), Settings(model="qian2014", custom=(given,)), (read_effect(given, model="qian2014"),)
    )
    base = models.refit(("before",), {p.in_equations: p.value for p in models.preset.parameters})
    seen = candidate_terms(models, base)
    force = TermCandidate((Term("spool", "w", "F", "share", ("F",), {}),), (1.0,), 1e-9, 0.5)
    assert _built(models, base, "proposed_1", force, seen) is None
    speed = TermCandidate((Term("spool", "w", "x", "share", ("x",), {}),), (1.0,), 1e-9, 0.5)
    assert _built(models, base, "proposed_1", speed, seen) is not None


def test_an_answer_that_grows_without_end_is_no_column():
    """Where small signals are not stable: no number overflows, and the other terms are weighed as ever."""
    matrix, _ = with_a_leak()
    models = CandidateModels.of(matrix, Settings(model="qian2014"))
    base = models.refit((), {p.in_equations: p.value for p in models.preset.parameters})
    runs = run_data(base, ["w", "P"])
    leak, flow = (Term("spool", "w", text, text, (name,), {}) for text, name in (("abs(P)", "P"), ("w * abs(w)", "w")))

    class Answer:
        def __init__(self, *growth: float) -> None:
            self.growth = np.array(growth)

        def to(self, samples):
            return (samples * self.growth)[:, :, None]

    alone = regressions.regression([leak], runs, {"w": [Answer(1.0)] * len(runs)}, models.band)
    with np.errstate(all="raise"):
        both = regressions.regression([leak, flow], runs, {"w": [Answer(1.0, 1e200)] * len(runs)}, models.band)
    assert both.gains[0] == pytest.approx(alone.gains[0], rel=1e-9)
    assert both.gains[1] == 0.0
    assert both.classes() == [[0]]

"""Each number by which models are compared and reported decides a case that lies within a third of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.diagnosis import candidate, prediction_horizon
from ident.diagnosis.candidate import Candidate, _ties
from ident.diagnosis.compared_records import _condition
from ident.diagnosis.competing_models import _chosen
from ident.diagnosis.cross_validation import _of_long_steps, _of_short_steps, fold_of_segments
from ident.diagnosis.discovery import discover
from ident.diagnosis.prediction_horizon import longer_horizon
from ident.diagnosis.report import better_with_fewer
from ident.diagnosis.run_consistency import _compared, inconsistent_parameters
from ident.diagnosis.tie_breaking import stable_minimum
from ident.diagnosis.verdict import contradicts
from ident.diagnosis.verification import VerifyChange
from ident.run import Run


@pytest.mark.parametrize(("ratio", "same"), [(1.15, True), (1.25, False)])
def test_tests_whose_commands_differ_in_size_by_a_fifth_are_of_two_conditions(ratio, same):
    """A step of half an octave is a factor of 1.41: within 1.19 of a level a command belongs to it."""
    shape = np.sin(np.arange(400.0))
    first, second = (Run("a", "", 1.0, {"command": size * shape / shape.std()}) for size in (1.0, ratio))
    assert (_condition(first, None) == _condition(second, None)) is same


@pytest.mark.parametrize(("gain", "longer"), [(8.5, False), (11.5, True)])
def test_longer_windows_have_to_make_the_records_more_likely_beyond_chance(monkeypatch, gain, longer):
    base, other = SimpleNamespace(effects=(), values={}, fitness=None, point=None), SimpleNamespace(effects=("a",))
    likely = {id(base): 0.0, id(other): gain}
    for name, made in {
        "longer": lambda *_: [3.0],
        "may_hide_an_effect": lambda *_: True,
        "_refitted": lambda *_: [other],
        "_log_likelihood": lambda one, _memory: likely[id(one)],
    }.items():
        monkeypatch.setattr(prediction_horizon, name, made)
    models = SimpleNamespace(effects={"a": None}, memory=None, over_windows=lambda *_: None)
    ranking = SimpleNamespace(ranking=())
    moves: Any = SimpleNamespace(base=base, models=models, latest=None, first_ranking=lambda _: ranking)
    assert (longer_horizon(moves, lambda _: None) is not None) is longer


def test_the_next_run_is_to_distinguish_three_models():
    parameters = [{"p": n} for n in range(5)]
    candidates = [SimpleNamespace(effect=str(n), parameters=of) for n, of in enumerate(parameters)]
    verdict = SimpleNamespace(indistinguishable=[tuple("01234")])
    found: Any = SimpleNamespace(candidates=candidates, verdict=verdict)
    assert _chosen(found) == parameters[:3]


# Held-out data


def test_a_single_run_has_eight_stretches_and_many_runs_four_folds():
    assert 1 + max(fold_of_segments(0, 32, 1)) == 8
    assert 1 + max(fold_of_segments(0, 32, 3)) == 4
    assert 1 + max(max(fold_of_segments(number, 32, 12)) for number in range(12)) == 4


@pytest.mark.parametrize(("step", "short"), [(0.0085, True), (0.0115, False)])
def test_one_linearisation_is_trusted_over_a_hundredth_of_an_axis(step, short):
    def simulate(points: Any, numbers: Any) -> Any:
        return [[np.zeros(1) for _ in numbers] for _ in points]

    assert bool(_of_short_steps(np.zeros(1), [np.array([step])], [[0]], simulate)) is short


@pytest.mark.parametrize(("best", "taken"), [(0.095, 0.1), (0.052, 0.05), (0.021, 0.02), (0.0052, 0.005)])
def test_a_long_step_is_tried_at_a_tenth_of_an_axis_and_at_shares_of_that(best, taken):
    """The other folds are explained better between nine and eleven tenths of what explains them best."""

    def simulate(points: Any, numbers: Any) -> Any:
        return [[np.array([float(point[0])]) for _ in numbers] for point in points]

    def error(residuals: Any, _fold: int) -> float:
        return 0.5 if 0.9 * best < residuals[0][0] < 1.1 * best else 1.0

    found = _of_long_steps(np.zeros(1), {0: np.array([0.7])}, simulate, error, [[0]])
    assert found[0][0][0] == pytest.approx(taken)


# Equality


@pytest.mark.parametrize(("less", "first"), [(0.85e-4, 0), (1.15e-4, 1)])
def test_rounding_may_decide_on_a_ten_thousandth_of_an_error(less, first):
    assert stable_minimum([0, 1], [1.0, 1.0 - less].__getitem__) == first


@pytest.mark.parametrize(("error", "ties"), [(1.017, True), (1.023, False)])
def test_models_that_the_data_cannot_tell_apart_tie_within_two_per_cent(monkeypatch, error, ties):
    monkeypatch.setattr(candidate, "indistinguishable", lambda *_: True)
    best, other = (Candidate(None, refit=SimpleNamespace(error=of)) for of in (1.0, error))  # type: ignore[arg-type]
    assert _ties(best, other) is ties


# Validation data, single runs, the report


@pytest.mark.parametrize(("rise", "contradicted"), [(1.7, False), (2.3, True)])
def test_an_effect_is_contradicted_where_the_error_rises_by_two_standard_errors(rise, contradicted):
    assert contradicts(VerifyChange("a", 0.1, 0.1 + 0.001 * rise, 0.001)) is contradicted


@pytest.mark.parametrize(("last", "told"), [(0.1085, False), (0.1115, True)])
def test_a_smaller_error_on_the_way_is_told_where_the_last_is_a_tenth_larger(last, told):
    steps: Any = [
        (name, SimpleNamespace(errors={"verify": error})) for name, error in ((None, 0.3), ("a", 0.1), ("b", last))
    ]
    assert (better_with_fewer(steps) == (0.1, ("b",))) is told


@pytest.mark.parametrize(("runs", "asked"), [(12, True), (13, False)])
def test_up_to_twelve_runs_are_fitted_alone(runs, asked):
    alone: list[int] = []
    refit = SimpleNamespace(parameters={})
    models: Any = SimpleNamespace(
        runs=[SimpleNamespace(id=n) for n in range(runs)],
        without=lambda _runs: SimpleNamespace(refit=lambda *_: alone.append(1) or refit),
    )
    fitted: Any = SimpleNamespace(effects=(), values={}, parameters={})
    inconsistent_parameters(models, fitted)
    assert bool(alone) is asked


@pytest.mark.parametrize(
    ("ratio", "square", "differ"),
    [
        (1.25, 100.0, False),
        (1.35, 100.0, True),
        (1.5, 10.55, False),
        (1.5, 11.2, True),
    ],
)
def test_two_runs_differ_by_a_third_and_beyond_a_chance_of_one_in_a_thousand(ratio, square, differ):
    """χ² of one degree of freedom exceeds 10.83 with that probability."""
    error = float((ratio - 1.0) / np.sqrt(2.0 * square))
    estimates: Any = [SimpleNamespace(value=value, std_error=error, unit="1") for value in (1.0, ratio)]
    assert (_compared("a", estimates, 1) is not None) is differ


@pytest.mark.parametrize(("error", "alone"), [(1.04, True), (1.06, False)])
def test_terms_alone_come_first_up_to_an_error_five_per_cent_larger(monkeypatch, error, alone):
    """Than that of terms in addition to an effect; without terms it leaves more."""
    named: Any = SimpleNamespace(
        complete=True,
        proposals=(),
        instead=lambda *_: named,
        error_with_terms=lambda *_: error,
    )
    further: Any = SimpleNamespace(complete=True, error_with_terms=lambda *_: 1.0, or_rejected=lambda _: further)
    monkeypatch.setattr(discover, "_search", lambda *_: further)
    monkeypatch.setattr(discover, "replace", lambda of, **_: of)
    refit = SimpleNamespace(held_out=SimpleNamespace(error=9.0), error=9.0)
    selection: Any = SimpleNamespace(base=refit, fitted=refit, added=("a",), ranking=())
    models: Any = SimpleNamespace(is_noise=lambda _: False)
    found: Any = discover._of_both_searches(models, selection, named, SimpleNamespace())  # type: ignore[arg-type]
    assert (found is named) is alone

"""Whether the data tell a lag from a delay: a cylinder in open loop whose records wander, and one that is still."""

from __future__ import annotations

import re
from functools import cache

import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.sentences import delay_sentence, verdict_text
from ident.diagnosis.total_delay import lag_ambiguities, total_delay
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.workflows import diagnose, identify
from tests.diagnosis.test_diagnose import measured
from tests.fit.test_windows import LAG, cylinder

SETTINGS = Settings(model="open_valve", fixed={"m0/A^2": 1.0, "c0": 1.0, "Ka/A^2": 1.7e-4, "Cl/A^2": 1e-7})
"""What no record of a cylinder in open loop tells is held: oil and mass that follow within a hundredth of a second."""


@cache
def fitted(wander: float) -> tuple[Matrix, FitResult]:
    """A cylinder whose records wander by so much a sample, and its fit."""
    matrix = cylinder(4, wander=wander)
    return matrix, identify(matrix, SETTINGS)


def judged(matrix: Matrix, fit: FitResult):
    """The lag of the fitted model, and what does as well in its place."""
    over = (fit.window.horizon, fit.window.memory) if fit.window else (None, None)
    models = CandidateModels.of(matrix, SETTINGS, (), *over)
    refit = models.refit((), {models.preset.parameter(name).in_equations: v for name, v in fit.values.items()})
    return total_delay(models, refit, refit)


def test_where_disturbances_hide_the_shape_of_the_answer_lag_and_delay_are_one_group():
    late = judged(*fitted(3e-3))
    assert late.parameter.name == "tau"
    assert {"command_delay", "acquisition_lag"} <= set(late.in_place)
    assert abs(late.fitted.value - LAG) < 4 * late.fitted.std_error
    said = delay_sentence(late)
    assert re.search(r"lags the command by 0\.1\d* ± 0\.0\d+ s\.", said)
    assert "tau" in said
    assert "command delay" in said
    assert said.startswith("At low frequency")
    assert delay_sentence(late, without=("spool_stiction",)).startswith(
        "Without spool stiction the output lags the command by"
    )


def test_a_clean_record_tells_a_lag_from_a_delay():
    late = judged(*fitted(0.0))
    assert late is None or "command_delay" not in late.in_place


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_a_diagnosis_says_it():
    found = diagnose(*fitted(3e-3), most=1, propose=False)
    assert "These data cannot tell which lag or delay causes it: tau" in found.verdict.text


def test_of_a_model_without_a_time_constant_of_its_own_nothing_is_said():
    matrix = cylinder(4, wander=3e-3, seconds=30.0)
    models = CandidateModels.of(matrix, Settings(model="motor"))
    refit = models.refit((), {})
    assert total_delay(models, refit, refit) is None


@pytest.mark.parametrize(
    ("valve", "recorder", "others"),
    [(2e-4, 3.5e-4, {"command_delay", "sensor_lag"}), (4e-4, 1e-3, set())],
)
def test_two_lags_that_two_others_stand_for_as_well_are_told_as_pairs(valve, recorder, others):
    """A valve's second order and a recorder's lag, hidden in data of the reference: short ones, and ones that show.

    The outputs of another pair, a delay of the command and one in the loop, lie seven deviations of the noise apart.
    """
    models = CandidateModels.of(measured(1.0, valve_second_order=valve, acquisition_lag=recorder), Settings())
    start = models.off | {p.in_equations: p.value for p in models.preset.parameters}
    start |= {models.strength("valve_second_order"): valve, models.strength("acquisition_lag"): recorder}
    refit = models.refit(("valve_second_order", "acquisition_lag"), start)
    found = lag_ambiguities(models, refit, refit.effects)
    assert found == [] if not others else {*found[0]} == {*refit.effects, *others}
    assert lag_ambiguities(models, refit, ("acquisition_lag",)) == []


def test_a_pair_is_said_to_be_one():
    errors = {"fit": 0.0105, "held_out": 0.0105, "verify": None}
    two = ("command_delay", "sensor_lag")
    said = verdict_text(two, [(*two, "valve_second_order", "acquisition_lag")], [], False, errors, 0.05)
    assert (
        "cannot tell which two of these are present: command delay, sensor lag, valve second order, acquisition lag"
        in said
    )

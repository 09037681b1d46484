"""What the records show before anything is fitted is said first: an input that is not recorded, an oscillation."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.checks.self_oscillation import self_oscillation
from ident.diagnosis.budget import SearchBudget
from ident.diagnosis.diagnose import Diagnoser, diagnose
from ident.diagnosis.result import Diagnosis, Verdict
from ident.diagnosis.unfitted import with_oscillations
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.matrix import Actuator, Matrix
from tests.checks import test_oscillation_at_rest as tested
from tests.checks.test_missing_input import RAISED, lowering, record

FIT = FitResult(
    "open_valve", (), {}, {}, (), (), {"fit": 0.5}, {"fit": 0.0}, {"fit": None}, (), "ga", 0, 0, 0.0, "", ""
)


@pytest.fixture
def found() -> Diagnosis:
    matrix = Matrix(Actuator("LD"), (record(RAISED + lowering(after=60), command=RAISED),))
    return diagnose(matrix, FIT, (), SearchBudget(most=1))


def test_nothing_is_named_for_an_input_that_is_not_recorded(found):
    assert found.complete
    assert (found.verdict.effects, found.verdict.unexplained) == ((), True)
    assert found.verdict.text.startswith("An input is not recorded")
    assert found.summary[0] == "Missing: an input that is not in the record of run loader."
    assert found.baseline.error["fit"] == 0.5


def test_an_oscillation_is_said_first_with_its_frequency_and_growth():
    swings = tested.record(0.02 * np.sin(2 * np.pi * 12.3 * tested.T), gain=7.0)
    found = with_oscillations(Diagnosis(candidates=(), verdict=Verdict(text="The rest.")), [self_oscillation(swings)])
    assert found.verdict.text.startswith(
        "The machine oscillates: in run loop the displacement swings by itself at 12.3"
    )
    partly = replace(found, verdict=Verdict(("dead_zone",), "stand_in", unexplained=True))
    assert partly.summary[0].startswith("The machine oscillates by itself: in run loop the displacement swings")
    assert partly.summary[2] == "Next: lower the gain of the loop, or leave run loop out of the fit, and fit again."
    assert set(found.to_json()["oscillation"][0]) == {"run", "frequency", "growth", "cause", "evidence"}


def test_an_oscillation_is_told_where_the_fitted_model_is_unstable_on_it(monkeypatch):
    """An error that asks for another fit would hide what was found; without an oscillation it stays one."""

    def unstable(_diagnoser: Diagnoser) -> Diagnosis:
        raise Unusable("bad-fit", "the fitted model is unstable on a run", "fit", "fit the model to this matrix")

    monkeypatch.setattr(Diagnoser, "diagnosis", unstable)
    swings = tested.record(0.02 * np.sin(2 * np.pi * 12.3 * tested.T), gain=7.0)
    found = diagnose(Matrix(Actuator("LD"), (swings,)), FIT, (), SearchBudget(most=1))
    assert found.oscillation[0]["frequency"] == pytest.approx(12.3, rel=0.01)
    assert "so no effect was looked for" in found.verdict.text
    assert (found.complete, found.baseline.error["fit"], found.verdict.standing) == (True, None, "nothing")
    assert found.summary[0].startswith("The machine oscillates by itself")
    with pytest.raises(Unusable, match="unstable on a run"):
        diagnose(Matrix(Actuator("LD"), (tested.record(0.02 * np.sin(0.1 * tested.T)),)), FIT, (), SearchBudget(most=1))


def test_the_json_says_where_the_input_acted_and_is_read_again(found):
    data = found.to_json()
    first = data["missing_inputs"][0]
    assert set(first) == {"run", "from", "to", "evidence"}
    assert first["from"] < first["to"]
    assert Diagnosis.from_json(data).missing_inputs == found.missing_inputs

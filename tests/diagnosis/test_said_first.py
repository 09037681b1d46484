"""Where an input is not recorded no effect is named for it, and it is said first."""

from __future__ import annotations

import pytest

from ident.diagnosis.budget import SearchBudget
from ident.diagnosis.diagnose import diagnose
from ident.diagnosis.result import Diagnosis
from ident.fit.result import FitResult
from ident.matrix import Actuator, Matrix
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


def test_the_json_says_where_the_input_acted_and_is_read_again(found):
    data = found.to_json()
    first = data["missing_inputs"][0]
    assert set(first) == {"run", "from", "to", "evidence"}
    assert first["from"] < first["to"]
    assert Diagnosis.from_json(data).missing_inputs == found.missing_inputs

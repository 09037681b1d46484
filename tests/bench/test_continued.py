"""A fit of a bench's records that begins where a fit or a diagnosis ended, and is never worse."""

from __future__ import annotations

import json

import pytest

from ident.diagnosis.parameter_estimate import ParameterEstimate
from ident.diagnosis.result import Diagnosis, Rung, Verdict
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.workflows import diagnose, identify
from tests.bench.sets import as_matrix
from tests.reference import kononykhin_reference as reference

SAME = 1e-6


@pytest.fixture(scope="module")
def matrix(full: bool) -> Matrix:
    """A set of an actuator with a spring that the model does not have; in the short form without the slow sines."""
    truth = reference.scattered(66)._replace(load=0.005)
    return as_matrix(truth, reference.full_set(truth, 66, short=not full))


@pytest.fixture(scope="module")
def fitted(matrix) -> FitResult:
    """What the procedures find, with the spring."""
    return identify(matrix, Settings(model="kononykhin", method="gradient", effects=("spring_load",)))


def promised(fit: FitResult) -> Diagnosis:
    """A diagnosis of the model without the spring whose last refit is this fit."""
    values = {
        name: ParameterEstimate(one.value, one.unit, one.std_error, one.symbol) for name, one in fit.parameters.items()
    }
    rung = Rung(added="spring_load", error=fit.error, parameters=values)
    settings = Settings(model="kononykhin", method="gradient").to_json()
    return Diagnosis(
        model="kononykhin",
        candidates=(),
        verdict=Verdict(("spring_load",)),
        ladder=(rung,),
        settings=settings,
        data_hash=fit.data_hash,
    )


@pytest.mark.parametrize("of", ["fit", "diagnosis"])
def test_it_is_the_same_model_with_no_greater_error(matrix, fitted, of, full):
    if of == "fit" and not full:
        pytest.skip("a second and more, for what the other one shows as well: run with --full")
    start = fitted if of == "fit" else Diagnosis.from_json(json.loads(json.dumps(promised(fitted).to_json())))
    further = identify(matrix, start=start)
    assert further.effects == ("spring_load",)
    assert (further.error["fit"] or 0.0) <= (1 + SAME) * (fitted.error["fit"] or 0.0)
    assert {*further.parameters} == {*fitted.parameters}
    assert (further.method, further.evolution) == ("refinement", ())
    assert f"begins where a {of} ended" in further.notes[0]


def test_the_fit_that_a_diagnosis_recommends_is_what_it_promised(matrix, full):
    """The whole way: the fit without the spring, its diagnosis, the fit that this recommends."""
    if not full:
        pytest.skip("twenty seconds: run with --full")
    plain = identify(matrix, Settings(model="kononykhin", method="gradient"))
    found = diagnose(matrix, plain, most=2)
    assert found.verdict.effects == ("spring_load",)
    fit = identify(matrix, start=found)
    assert (fit.error["fit"] or 0.0) <= (1 + SAME) * (found.ladder[-1].error["fit"] or 0.0)

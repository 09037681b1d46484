"""What the candidate models say of a residual: noise below its floor, coloured noise, or more."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.evidence.evidence import BlockMean
from ident.diagnosis.verdict import is_noise
from ident.fit.settings import Settings
from ident.matrix import Actuator
from ident.noise.floor import Floors
from tests.diagnosis.test_sentences import matrix

NOT_PREDICTED = BlockMean(0.0, 0.01, 60)


def models_with_floor(floor: float | None, in_band: bool) -> CandidateModels:
    """Candidate models whose noise floor is stated."""
    models = CandidateModels.of(matrix(Actuator("ANY")), Settings(model="open_valve"))
    models.__dict__["floors"] = Floors({run.id: floor for run in models.matrix.runs}, 1e6, in_band=in_band)
    return models


def refitted(error: float) -> SimpleNamespace:
    """A refit of whose residual the inputs predict nothing."""
    return SimpleNamespace(error=error, stable=True, predicted_share=NOT_PREDICTED)


@pytest.mark.parametrize(
    ("error", "floor", "in_band", "more"),
    [
        (0.01, 0.01, False, False),
        (0.019, 0.01, False, False),  # coloured noise
        (0.019, 0.01, True, True),  # repeats tell the floor
        (0.03, 0.01, False, True),  # more than coloured noise
    ],
)
def test_a_residual_that_no_input_predicts_is_noise_where_repeats_do_not_tell_the_floor(error, floor, in_band, more):
    assert is_noise(models_with_floor(floor, in_band).last_residual(refitted(error))) is not more


@pytest.mark.parametrize(("ratio", "asked"), [(1.5, True), (2.5, False)])
def test_coloured_noise_makes_no_error_of_three_times_the_floor(ratio, asked):
    residual = models_with_floor(0.01, in_band=False).last_residual(refitted(0.01 * ratio))
    assert (residual.predicted is not None) is asked

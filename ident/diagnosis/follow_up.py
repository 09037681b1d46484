"""The follow-up of a diagnosis: the error budget of the given model, and the run that the lab should add."""

from __future__ import annotations

from collections.abc import Sequence

from ident.comparison.compare import compare
from ident.design.proposal import propose
from ident.diagnosis.competing_models import competing_models
from ident.diagnosis.result import Diagnosis, NextRun
from ident.effects.effect import Effect
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.matrix import Matrix
from ident.plain import read
from ident.residuals.budget import Budget, budget


def error_budget(matrix: Matrix, fit: FitResult) -> Budget | None:
    """Noise, linear and nonlinear part of the fit's error; None where the model is unstable at every run."""
    try:
        return budget(compare(matrix, fit))
    except Unusable as error:
        if error.code != "unstable-model":
            raise
        return None


def next_run(matrix: Matrix, diagnosis: Diagnosis, custom: Sequence[Effect] = ()) -> NextRun | None:
    """The run that best distinguishes the models in question; None where no run can be proposed."""
    try:
        proposal = propose(competing_models(diagnosis, custom), matrix, diagnosis.seed)
    except Unusable as error:
        if error.code not in ("no-experiment", "bad-diagnosis"):
            raise
        return None
    return read(NextRun, proposal.to_json() | {"conditions": proposal.conditions, "run": proposal.entry()})

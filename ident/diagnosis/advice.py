"""What goes with a diagnosis: the error budget of the model that was given, and the run that the lab should add."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ident.comparison.compare import compare
from ident.design.proposal import propose
from ident.design.rivals import floor_of, rivals, trusted
from ident.diagnosis.result import Diagnosis
from ident.effects.effect import Effect
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.matrix import Matrix
from ident.residuals.budget import budget


def error_budget(matrix: Matrix, fit: FitResult) -> dict[str, Any]:
    """Noise, linear and nonlinear part of the fit's error; empty where the model is unstable at every run."""
    try:
        return budget(compare(matrix, fit)).to_json()
    except Unusable as error:
        if error.code != "unstable-model":
            raise
        return {}


def next_run(matrix: Matrix, found: Diagnosis, custom: Sequence[Effect] = ()) -> dict[str, Any]:
    """The run that tells most of what a diagnosis leaves in question; empty where no run can be proposed."""
    data = found.to_json()
    try:
        proposal = propose(rivals(data, custom), trusted(data, matrix), floor_of(data), found.seed)
    except Unusable as error:
        if error.code not in ("no-experiment", "bad-diagnosis"):
            raise
        return {}
    return proposal.to_json() | {"conditions": proposal.conditions, "run": proposal.entry()}

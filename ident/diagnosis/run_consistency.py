"""Whether the runs ask for the same parameters: one machine has one value of each, in all of its runs.

The model is refitted to each run alone. With values θ_r and standard errors s_r of R runs, and their mean θ weighted by
1/s_r²,

    χ² = Σ (θ_r − θ)²/s_r²

has R − 1 degrees of freedom where the runs agree (the test of Cochran 1954 for the heterogeneity of estimates). Where
it does not agree, the standard error of the fit to all runs, which holds for one value, says nothing: the machine was
another in each run, or another signal drives it than the one that was recorded.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtri

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.parameter_estimate import ParameterEstimate
from ident.fit.uncertainty import DETERMINED
from ident.parallel import each
from ident.run import Run


@dataclass(frozen=True)
class InconsistentParameter:
    """A parameter for which runs alone give values from `least` to `most`, SI."""

    name: str
    unit: str
    least: float
    most: float


def inconsistent_parameters(models: CandidateModels, fitted: FittedModel) -> tuple[InconsistentParameter, ...]:
    """The parameters of a fitted model that each of its runs determines, with values that differ beyond chance."""
    runs = models.runs
    if not 2 <= len(runs) <= CRITERIA.consistency.most_runs:
        return ()

    def alone(run: Run) -> dict[str, ParameterEstimate]:
        of_run = models.without(other.id for other in runs if other.id != run.id)
        return of_run.refit(fitted.effects, fitted.values).parameters

    by_run = each(alone, runs)
    names = [name for name, estimate in fitted.parameters.items() if estimate.std_error is not None]
    found = (_compared(name, [estimates[name] for estimates in by_run], len(names)) for name in names)
    return tuple(parameter for parameter in found if parameter is not None)


def _compared(name: str, estimates: Sequence[ParameterEstimate], parameters: int) -> InconsistentParameter | None:
    """A parameter by its estimates from single runs; None where a run does not determine it, or they agree."""
    values = np.array([estimate.value for estimate in estimates])
    errors = np.array([estimate.std_error or np.nan for estimate in estimates])
    if not np.all(errors > 0) or np.any(errors > DETERMINED * np.abs(values)):
        return None
    mean = np.average(values, weights=errors**-2)
    limit = chdtri(len(values) - 1, CRITERIA.consistency.chance / parameters)
    least, most = sorted((float(values.min()), float(values.max())), key=abs)
    if np.sum((values - mean) ** 2 / errors**2) <= limit or abs(most) < CRITERIA.consistency.ratio * abs(least):
        return None
    return InconsistentParameter(name, estimates[0].unit, least, most)

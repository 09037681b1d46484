"""Akaike's information criterion: which of two models fitted to the same samples predicts better for its size.

AIC = Σ n ln ε² + 2 p, with eq. (17) ε of each run, its n samples and the p fitted parameters: the residual is taken as
white, each run with a variance of its own, and what all models of the same samples share is left out (H. Akaike, IEEE
Trans. Automatic Control 19 (1974) 716). The smaller is the better.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from ident.fit.result import FitResult
from ident.unstable import UNSTABLE


def aic(errors: Sequence[float], samples: Sequence[int], parameters: int) -> float | None:
    """AIC of runs with these errors, eq. (17), 1, and numbers of samples; None where the model is unstable on one."""
    if not errors or not all(0.0 < error < UNSTABLE for error in errors):
        return None
    pairs = zip(errors, samples, strict=True)
    return sum(n * 2.0 * math.log(error) for error, n in pairs) + 2.0 * parameters


def same_samples(first: FitResult, second: FitResult) -> bool:
    """Whether two fits were made to the same samples of the same data, so that their criteria may be compared."""
    return first.data_hash == second.data_hash and _fitted(first) == _fitted(second)


def aic_change(fit: FitResult, before: FitResult) -> float | None:
    """The AIC of a fit less that of an earlier one; None where one is unknown or their samples differ."""
    if fit.aic is None or before.aic is None or not same_samples(fit, before):
        return None
    return fit.aic - before.aic


def _fitted(fit: FitResult) -> frozenset[str]:
    return frozenset(run.id for run in fit.runs if run.use == "fit" and run.id not in fit.left_out)

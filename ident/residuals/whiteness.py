"""Is the residual of each run white: the test of Ljung and Box (Biometrika 65 (1978) 297).

Q = n (n + 2) Σ ρ_e(k)² / (n − k) over k = 1 … m of a white e has the χ² distribution with m degrees of freedom. A run
passes where a white residual of its length is as correlated by chance in 1 % of cases or more.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ident.comparison.compare import Comparison, RunComparison
from ident.residuals.correlation import SURE, correlation
from ident.run import USES
from ident.words.message import message


@dataclass(frozen=True)
class Whiteness:
    """Of some runs: how many there are, how many pass, and the verdict on all of them.

    All pass where the least p-value of n runs is beyond chance among so many: p > 1 − 0.99^(1/n) (Šidák).
    """

    runs: int
    white: int
    passed: bool

    def __str__(self) -> str:
        """ "fail (white on 3 of 12 runs)"."""
        return str(message("white.pass" if self.passed else "white.fail", white=self.white, runs=self.runs))


def p_value(compared: RunComparison, lags: int | None = None) -> float:
    """The share of white residuals of the run's length that are as correlated, over `lags` or the usual number.

    1 where the residual is zero.
    """
    from scipy.special import chdtrc  # noqa: PLC0415 - scipy is loaded where it is first used

    if not np.ptp(compared.run.measured - compared.modelled):
        return 1.0
    rho = correlation(compared, lags).auto.values[1:]
    n, k = compared.run.length, np.arange(1, len(rho) + 1)
    return float(chdtrc(len(rho), n * (n + 2.0) * np.sum(rho**2 / (n - k))))


def whiteness(runs: Sequence[RunComparison]) -> Whiteness | None:
    """The test of some runs; None where there are none, or the model is unstable on one."""
    if not runs or any(one.unstable for one in runs):
        return None
    values = [p_value(one) for one in runs]
    white = sum(value > 1.0 - SURE for value in values)
    return Whiteness(len(runs), white, min(values) > 1.0 - SURE ** (1.0 / len(runs)))


def by_use(comparison: Comparison) -> Mapping[str, Whiteness]:
    """The test of the runs of each use that has some, but for those that the fit left out."""
    left_out = comparison.fit.left_out
    meant = {use: [one for one in comparison.runs if one.run.use == use and one.run.id not in left_out] for use in USES}
    return {use: found for use, runs in meant.items() if (found := whiteness(runs)) is not None}

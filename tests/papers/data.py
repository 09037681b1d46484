"""What several rows share: records of the references, and fits of them."""

from __future__ import annotations

from functools import cache

from ident.comparison.compare import Comparison
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.workflows import compare, identify
from tests.acceptance.matrices import NOISE, as_matrix, records_of
from tests.bench.recovery import Found, recover
from tests.fit import rig
from tests.reference import qian_reference as qian

SECONDS, SEED = 2.0, 1
PRINTED = {
    "Z0": "1.48e-5 m^3/(s*kPa) as printed",
    "tau": "0.0036 s",
    "Cl": "1e-8 m^3/(s*kPa)",
    "c0": "3.2 kN*s/m",
    "m0": "4.25 kg",
    "Ka": "1.39e-10 m^3/kPa",
}
"""Table 4 as it stands in the print."""
BOUNDS = {
    "Z0": ("1e-5 m^3/(s*kPa) as printed", "2e-5 m^3/(s*kPa) as printed"),
    "tau": ("0.001 s", "0.006 s"),
    "Cl": ("2e-9 m^3/(s*kPa)", "2e-8 m^3/(s*kPa)"),
    "c0": ("0.8 kN*s/m", "5 kN*s/m"),
    "m0": ("1 kg", "10 kg"),
    "Ka": ("2e-12 m^3/kPa", "2e-10 m^3/kPa"),
}
"""Table 2 as it stands in the print."""


@cache
def paper_matrix() -> Matrix:
    """The 63 + 21 runs of the reference at Table 4, 2 s each, 0.5 % noise, seed 1."""
    return as_matrix(records_of(SECONDS, "linear", SEED), "linear")


@cache
def paper_fit(method: str = "ga") -> FitResult:
    """The fit of the runs."""
    return identify(paper_matrix(), Settings(seed=SEED, method=method))


@cache
def paper_comparison() -> Comparison:
    """Every run against the fitted model."""
    return compare(paper_matrix(), paper_fit())


def furthest(fit: FitResult) -> float:
    """The largest relative deviation (%) of the six parameters from those that made the data."""
    truth = qian.Plant()._asdict()
    return max(100 * abs(one.value / truth[name] - 1) for name, one in fit.parameters.items())


@cache
def bench(seed: int = 0) -> Found:
    """An actuator of the bench's reference, recorded and analysed."""
    return recover(seed)


@cache
def fifth_order() -> tuple[Matrix, FitResult]:
    """The rig of fifth order, machine 0, with its fit from displacement, load pressure and spool."""
    matrix = rig.matrix(rig.machine(0), 0, rig.ALL)
    return matrix, identify(matrix, Settings(model="strano", seed=1))


__all__ = ["NOISE", "bench", "fifth_order", "furthest", "paper_comparison", "paper_fit", "paper_matrix"]

"""The errors of one run as a result keeps them, bounded, and the size of the residual in the unit of the output."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol, TypedDict

import numpy as np

from ident.fit.result import RunError
from ident.unstable import UNSTABLE, bounded
from ident.words.percent import PER_CENT


class Rmse(TypedDict):
    """Two fields of a fit: the RMSE by use, and its unit."""

    rmse: dict[str, float | None]
    rmse_unit: str


class Measured(Protocol):
    """A run, or the record of a bench."""

    @property
    def id(self) -> str:
        """Its name in the matrix."""
        ...

    @property
    def use(self) -> str:
        """Whether it is fitted or verifies."""
        ...


def run_error(
    run: Measured, error: float, offset: float, deviation: float, unit: str, of_transducer: float = 0.0
) -> RunError:
    """Eq. (17), the offset, the error with the mean counted and the RMSE of a run whose output has this deviation.

    RMS(x − x_m)² = std(x − x_m)² + mean(x − x_m)², so that RMS(x − x_m)/std(x_m) = √(error² + o²), o being the offset
    less that `of_transducer`, which is in `unit`. Of a run on which the model is unstable each is bounded by
    :data:`ident.unstable.UNSTABLE`, and there is no RMSE.
    """
    error = bounded(error)
    if error < UNSTABLE:
        with_mean = float(np.hypot(error, offset - of_transducer / deviation))
        return RunError(run.id, run.use, error, float(offset), with_mean, with_mean * deviation, unit)
    offset = float(np.clip(np.nan_to_num(offset, nan=UNSTABLE), -UNSTABLE, UNSTABLE))
    return RunError(run.id, run.use, error, offset, UNSTABLE, None, unit)


def rmse_of(errors: Sequence[RunError], shares: Mapping[str, Sequence[float]]) -> Rmse:
    """The RMSE averaged over the runs of each use, that count these shares in the mean.

    None where there are none, the model is unstable on one, or the outputs have several units.
    """
    units = {one.unit for one in errors}
    found: dict[str, float | None] = {}
    for use, of in shares.items():
        sizes = [one.rmse for one in errors if one.use == use]
        known = [size for size in sizes if size is not None]
        told = bool(known) and len(known) == len(sizes) and len(units) == 1
        found[use] = float(np.average(known, weights=of)) if told else None
    return Rmse(rmse=found, rmse_unit=units.pop() if len(units) == 1 else "")


def fit_percent(errors: Sequence[RunError], with_mean: Mapping[str, float | None]) -> dict[str, float | None]:
    """The fit to the data of each use, 100 (1 − RMS(x − x_m)/std(x_m)), from the mean error `with_mean` over its runs.

    None where there are none, or the model is unstable on one.
    """
    unstable = {one.use for one in errors if one.unstable}
    return {
        use: None if error is None or use in unstable else PER_CENT * (1.0 - error) for use, error in with_mean.items()
    }

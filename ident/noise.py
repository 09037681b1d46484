"""The noise floor: how small eq. (17) can become on a run, read off the record where the command has no power."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import scipy.signal

from ident.matrix import USES, Matrix, Run
from ident.parallel import each

_CLEAR = 1.6  # times the band edge: beyond it a Hann window lets less than 1e-6 of the band's power through
_LEAST = 0.2  # of the Nyquist frequency must be left above that, to average over


def noise_floor(run: Run, band: float) -> float | None:
    """Standard deviation of white measurement noise over that of the measured output; None where it cannot be told.

    The power density of the record above `band` (rad/s, where the command ends) is taken for the noise's at all
    frequencies: exact for white noise, a lower bound for noise that lives in the band.
    """
    nyquist, clear = run.sample_rate / 2, _CLEAR * band / (2 * np.pi)
    if clear > (1 - _LEAST) * nyquist or run.length < 256:
        return None
    segment = min(run.length, 8192)
    frequency, power = scipy.signal.welch(run.measured, run.sample_rate, nperseg=segment, detrend="constant")
    # Kinks of friction and dead zones reach far beyond the command's band; half-way up they are gone.
    density = float(np.mean(power[(frequency > max(clear, nyquist / 2)) & (frequency < 0.98 * nyquist)]))
    return float(np.sqrt(density * nyquist) / np.std(run.measured))


def noise_floors(matrix: Matrix, band: float) -> Mapping[str, float | None]:
    """The noise floor averaged over the runs of each use; None where it cannot be told of every run."""
    return averaged(matrix, floors_by_run(matrix, band))


def floors_by_run(matrix: Matrix, band: float) -> Mapping[str, float | None]:
    """The noise floor of each run by its id."""
    floors = each(lambda run: noise_floor(run, band), matrix.runs)
    return {run.id: floor for run, floor in zip(matrix.runs, floors, strict=True)}


def averaged(matrix: Matrix, floors: Mapping[str, float | None]) -> Mapping[str, float | None]:
    """Floors by run averaged over the runs of each use; None where one of them is."""
    return {use: _mean([floors[run.id] for run in matrix.of_use(use)]) for use in USES}


def _mean(floors: Sequence[float | None]) -> float | None:
    known = [floor for floor in floors if floor is not None]
    return float(np.mean(known)) if known and len(known) == len(floors) else None

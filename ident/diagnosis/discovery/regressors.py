"""The columns of a regression over terms: the response of a run's output to each, sensitivities and residual."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.discovery.run_data import RunData
from ident.diagnosis.discovery.term import Term
from ident.residuals.decimation import Response
from ident.rounding import EPSILON, TINY

Array = NDArray[np.float64]
_BATCH = 128
"""Terms whose responses are worked out together: the responses to all terms at once are large. No answer depends
on it."""
_COLUMNS_AT_ONCE = 32
"""Terms whose samples are simulated to the output at once: they stay in the processor's cache. No answer depends on
it."""


@dataclass(frozen=True)
class Regressors:
    """The columns of one run: `known` is [J, r] within the `band`, (n, p+1), all over the residual's `size`.

    The nuisance parameters of the run are projected out of all columns by the orthonormal `basis`, (n, s). All numbers
    are finite: a column that is not finite is set to zero, and has no part in the regression on this run.
    """

    record: RunData
    band: float
    known: Array
    basis: Array
    size: float

    @classmethod
    def of(cls, record: RunData, band: float) -> Regressors:
        """The columns of a run; `band` in rad/s."""
        known, _ = _within(np.column_stack([record.sensitivities, record.residual]), record, band)
        basis = np.empty((len(known), 0))
        if record.free.shape[1]:
            free, _ = _within(record.free, record, band)
            basis = scipy.linalg.orth(free / np.maximum(np.linalg.norm(free, axis=0), TINY))
        known = known - basis @ (basis.T @ known)
        least = EPSILON * float(np.std(record.run.measured)) * float(np.sqrt(len(known)))
        size = max(float(np.linalg.norm(known[:, -1])), least, np.finfo(float).tiny)
        return cls(record, band, known / size, basis, size)

    def to(self, terms: Sequence[Term], path: Response) -> tuple[Array, NDArray[np.bool_]]:
        """T * φ of terms that add to one signal, (n, terms), and whether each is finite, (terms,).

        `path` is the response from that signal to the output. Where the linear model is unstable a response diverges.
        """
        step = _COLUMNS_AT_ONCE
        parts = [self._answers(terms[k : k + step], path) for k in range(0, len(terms), step)]
        found, sound = np.hstack([rows for rows, _ in parts]), np.concatenate([finite for _, finite in parts])
        return np.asarray((found - self.basis @ (self.basis.T @ found)) / self.size), sound

    def _answers(self, terms: Sequence[Term], path: Response) -> tuple[Array, NDArray[np.bool_]]:
        """T * φ before the nuisance parameters of the run are projected out, in the unit of the output."""
        samples = np.column_stack([term.samples(self.record.signals, self.record.rate) for term in terms])
        return _within(path.to(samples)[:, :, 0], self.record, self.band)


def batches(terms: Sequence[Term]) -> list[list[int]]:
    """The numbers of terms that add to one signal, at most :data:`_BATCH` together."""
    by_signal: dict[str, list[int]] = {}
    for i, term in enumerate(terms):
        by_signal.setdefault(term.path, []).append(i)
    return [here[k : k + _BATCH] for here in by_signal.values() for k in range(0, len(here), _BATCH)]


def _within(rows: Array, record: RunData, band: float) -> tuple[Array, NDArray[np.bool_]]:
    """The columns within the band or the windows, and whether each is finite: all others are zero.

    They are the lines of their spectra in the band, or, with windows, the columns counted from where each window
    begins.
    """
    sound = np.max(np.abs(rows), axis=0, initial=0.0) < CRITERIA.discovery.diverged  # false for NaN
    rows = np.where(sound, rows, 0.0)
    if record.anchoring.window:
        return record.anchoring(rows), sound
    spectrum = np.fft.rfft(rows, axis=0)
    lines = np.fft.rfftfreq(len(rows), 1.0 / record.rate) * 2 * np.pi
    inside = spectrum[(lines > 0) & (lines <= CRITERIA.discovery.band * band)]
    return np.concatenate([inside.real, inside.imag]), sound

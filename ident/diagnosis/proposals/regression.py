"""One linear regression for all terms: which of them, beside the parameters, explain what is left.

A small term φ at a place changes the output by the response of the linearised chain to it, T * φ. With J what
parameters and first states do and r the residual,

    r = Σ θ_i T * φ_i + J δ + noise

within the command's band, each run over the size of its residual. Only the sums of products of [T * φ, J, r] are kept,
summed run by run; J is taken off by its Schur complement.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ident.diagnosis.proposals.records import Record
from ident.diagnosis.proposals.terms import Term
from ident.fit.simulated_runs import anchored
from ident.parallel import each
from ident.residuals.decimation import Response

Array = NDArray[np.float64]
_ABSORBED = 1e-4  # of a term's power that the parameters leave: less, and they do what it does
ALIKE = 0.999  # cosine of two terms that the data cannot tell apart
WIDE = 1.3  # of the command's band is looked at


@dataclass(frozen=True)
class Regression:
    """Products (m, m) of the terms less what the parameters do, with the residual, (m,); `left` is its power."""

    terms: tuple[Term, ...]
    products: Array
    with_residual: Array
    left: float

    @cached_property
    def gains(self) -> Array:
        """The share of the residual's power that each term takes off by itself, (m,)."""
        power = np.diag(self.products)
        return np.asarray(np.where(power > 0, self.with_residual**2 / np.maximum(power, 1e-300), 0.0) / self.left)

    def classes(self) -> list[list[int]]:
        """Terms by what they explain, best first; those of one class cannot be told apart."""
        size, gains = np.sqrt(np.maximum(np.diag(self.products), 1e-300)), self.gains
        rest = [int(i) for i in np.argsort(-gains, kind="stable") if gains[i] > 0]
        found = []
        while rest:
            first = rest[0]
            cosine = np.abs(self.products[first, rest]) / size[first] / size[rest]
            found.append([i for i, c in zip(rest, cosine, strict=True) if c > ALIKE])
            rest = [i for i, c in zip(rest, cosine, strict=True) if c <= ALIKE]
        return found


def regression(
    terms: Sequence[Term], runs: Sequence[Record], paths: dict[str, list[Response]], band: float
) -> Regression:
    """The products of all terms over some runs; `paths` has, for each signal that is added to, each run's response."""

    def of_run(i: int) -> Array:
        return _products(terms, runs[i], {at: found[i] for at, found in paths.items()}, band)

    total = sum(each(of_run, range(len(runs))), np.zeros(()))
    m = len(terms)
    known = total[m:-1, m:-1] if len(total) > m + 1 else np.zeros((0, 0))
    scale = np.sqrt(np.maximum(np.diag(known), 1e-300))
    cross = np.delete(total[m:-1], np.s_[m:-1], axis=1) / scale[:, None]  # J with [terms, r]
    strengths, directions = scipy.linalg.eigh(known / scale[:, None] / scale) if len(known) else (np.ones(0), known)
    seen = strengths > 1e-10 * strengths.max(initial=0.0)
    explained = (directions[:, seen].T @ cross) / np.sqrt(strengths[seen])[:, None]
    of = np.delete(np.delete(total, np.s_[m:-1], axis=0), np.s_[m:-1], axis=1) - explained.T @ explained
    absorbed = np.diag(of)[:m] < _ABSORBED * np.diag(total)[:m]
    products, with_residual = of[:m, :m].copy(), of[:m, m].copy()
    products[absorbed], products[:, absorbed], with_residual[absorbed] = 0.0, 0.0, 0.0
    return Regression(tuple(terms), products, with_residual, float(of[m, m]))


def _products(terms: Sequence[Term], record: Record, paths: dict[str, Response], band: float) -> Array:
    """[T * φ, J, r] of one run within the band, multiplied with itself; J has the run's own free states taken off."""
    n = len(record.residual)
    columns = np.empty((n, len(terms)))
    for at, path in paths.items():
        here = [i for i, term in enumerate(terms) if term.at == at]
        samples = np.column_stack([terms[i].samples(record.signals, record.rate) for i in here])
        columns[:, here] = path.to(samples)[:, :, 0]
    rows = np.column_stack([columns, record.sensitivities, record.residual])
    rows[~np.isfinite(rows)] = 0.0
    if record.free.shape[1]:
        rows -= record.free @ np.linalg.lstsq(record.free, rows, rcond=1e-9)[0]
    if record.window:
        return _multiplied(anchored(rows, record.window))
    spectrum = np.fft.rfft(rows - rows.mean(axis=0), axis=0)
    bins = np.fft.rfftfreq(n, 1.0 / record.rate) * 2 * np.pi
    inside = spectrum[(bins > 0) & (bins <= WIDE * band)]
    return _multiplied(np.concatenate([inside.real, inside.imag]))


def _multiplied(rows: Array) -> Array:
    """Products of columns, the last of size one."""
    rows = rows / max(float(np.linalg.norm(rows[:, -1])), 1e-300)
    return np.asarray(rows.T @ rows)

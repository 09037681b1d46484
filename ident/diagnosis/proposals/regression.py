"""One linear regression for all terms: which of them, beside the parameters, explain what is left.

A small term φ at a place changes the output by the response of the linearised chain to it, T * φ. With J what
parameters and first states do and r the residual,

    r = Σ θ_i T * φ_i + J δ + noise

within the command's band, each run over the size of its residual. Only the sums of products of [T * φ, J, r] are kept,
summed run by run; J is taken off by its Schur complement.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial

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
_DIGITS = 8  # of what a term explains: the rest is rounding
_BLOCK = 128  # terms whose responses are worked out together
_AT_ONCE = 8  # runs
_WITHOUT_END = 1e60  # of the output, for a strength of one: no power of a signal comes near


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
        """Terms by what they explain, best first; those of a class, in the list's order, cannot be told apart."""
        size, gains = np.sqrt(np.maximum(np.diag(self.products), 1e-300)), np.round(self.gains, _DIGITS)
        rest = np.argsort(-gains, kind="stable")
        rest = rest[gains[rest] > 0]
        found = []
        while len(rest):
            first = rest[0]
            alike = np.abs(self.products[first, rest]) > ALIKE * size[first] * size[rest]
            alike[0] = True
            found.append(sorted(int(i) for i in rest[alike]))
            rest = rest[~alike]
        return found


def regression(
    terms: Sequence[Term], runs: Sequence[Record], paths: dict[str, list[Response]], band: float
) -> Regression:
    """The products of all terms over some runs; `paths` has, for each signal that is added to, each run's response."""

    total = np.zeros(())
    for first in range(0, len(runs), _AT_ONCE):
        some = slice(first, first + _AT_ONCE)
        rows = _rows(terms, runs[some], {at: of[some] for at, of in paths.items()}, band)
        total = total + np.hstack(each(partial(np.matmul, rows.T), np.array_split(rows, 2, axis=1)))
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


def _rows(terms: Sequence[Term], runs: Sequence[Record], paths: Mapping[str, Sequence[Response]], band: float) -> Array:
    """[T * φ, J, r] of some runs within the band, one below the other, over the size of each run's residual.

    A block of columns after the other: the responses to all at once are large. What is free in a run is taken off.
    """
    by_place = [[i for i, term in enumerate(terms) if term.at == at] for at in paths]
    blocks = [here[k : k + _BLOCK] for here in by_place for k in range(0, len(here), _BLOCK)]

    def of_block(of: tuple[int, list[int]]) -> Array:
        run, here = of
        samples = np.column_stack([terms[i].samples(runs[run].signals, runs[run].rate) for i in here])
        found = _within(paths[terms[here[0]].at][run].to(samples)[:, :, 0], runs[run], band)
        # Where small signals are not stable an answer grows without end: it tells nothing of the run.
        return np.where(np.max(np.abs(found), axis=0, initial=0.0) < _WITHOUT_END, found, 0.0)

    answers = iter(each(of_block, [(run, here) for run in range(len(runs)) for here in blocks]))
    every = []
    for record in runs:
        known = _within(np.column_stack([record.sensitivities, record.residual]), record, band)
        rows = np.empty((len(known), len(terms) + known.shape[1]))
        rows[:, len(terms) :] = known
        for here in blocks:
            rows[:, here] = next(answers)
        if record.free.shape[1]:
            free = _within(record.free.copy(), record, band)
            basis = scipy.linalg.orth(free / np.maximum(np.linalg.norm(free, axis=0), 1e-300), rcond=1e-9)
            rows -= basis @ (basis.T @ rows)
        every.append(rows / max(float(np.linalg.norm(rows[:, -1])), 1e-300))
    return np.concatenate(every)


def _within(rows: Array, record: Record, band: float) -> Array:
    """Columns over time as what of them is seen: the lines of their spectra in the band, or the windows they begin."""
    rows[~np.isfinite(rows)] = 0.0
    if record.window:
        return anchored(rows, record.window)
    spectrum = np.fft.rfft(rows, axis=0)
    lines = np.fft.rfftfreq(len(rows), 1.0 / record.rate) * 2 * np.pi
    inside = spectrum[(lines > 0) & (lines <= WIDE * band)]
    return np.concatenate([inside.real, inside.imag])

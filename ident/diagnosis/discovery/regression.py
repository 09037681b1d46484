"""One linear regression for all terms: the part of the residual that each explains in addition to the parameters.

A small term φ at a place changes the output by the response of the linearised chain to it, T * φ. With J the
sensitivities to parameters and initial states and r the residual,

    r = Σ θ_i T * φ_i + J δ + noise

within the command's band, each run over the size of its residual. Only the sums of products of [T * φ, J, r] are kept,
summed run by run; J is eliminated by its Schur complement.

Terms of one form that differ by the first values of their shapes, as the frequencies of a pulsation, come to one
optimum in a refit. There are thousands of them on a long record: each is correlated with the residual alone, and only
the best one of each form with all other terms.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.discovery.regressors import Regressors, batches
from ident.diagnosis.discovery.run_data import RunData
from ident.diagnosis.discovery.term import Term
from ident.parallel import each
from ident.residuals.decimation import Response
from ident.rounding import TINY

Array = NDArray[np.float64]
_RUNS_AT_ONCE = 4
"""Runs whose columns lie side by side in memory. No answer depends on it."""


@dataclass(frozen=True)
class Regression:
    """Products (m, m) of the terms without the parameters' part, and with the residual, (m,), whose power is `left`.

    Each form with shapes has its best one of the `looked_at` terms here. `left_out` counts the terms whose response is
    finite in no run.
    """

    terms: tuple[Term, ...]
    products: Array
    with_residual: Array
    left: float
    looked_at: int
    left_out: int = 0

    @cached_property
    def gains(self) -> Array:
        """The share of the residual's power that each term takes off by itself, (m,)."""
        return _gains(np.diag(self.products), self.with_residual, self.left)

    def share(self, taken: Array) -> Array:
        """The share of the residual's power that is `taken`; 0 where there is no residual."""
        return _share(taken, self.left)

    def classes(self) -> list[list[int]]:
        """Classes of terms that the data cannot tell apart, the best class first; a class is in the order of the
        terms."""
        size, gains = np.sqrt(np.maximum(np.diag(self.products), TINY)), np.round(self.gains, CRITERIA.discovery.digits)
        rest = np.argsort(-gains, kind="stable")
        rest = rest[gains[rest] > 0]
        found = []
        while len(rest):
            first = rest[0]
            same_class = np.abs(self.products[first, rest]) > CRITERIA.discovery.same_class * size[first] * size[rest]
            same_class[0] = True
            found.append(sorted(int(i) for i in rest[same_class]))
            rest = rest[~same_class]
        return found


def regression(
    terms: Sequence[Term], runs: Sequence[RunData], paths: Mapping[str, Sequence[Response]], band: float
) -> Regression:
    """The products of terms over some runs; `paths` has, for each signal that is added to, each run's response."""
    beside = each(partial(Regressors.of, band=band), runs)
    known = np.sum([columns.known.T @ columns.known for columns in beside], axis=0)
    some, lost = _leading(terms, beside, paths, known)
    m, total, sound = len(some), np.zeros(()), np.zeros(len(some), dtype=bool)
    for first in range(0, len(beside), _RUNS_AT_ONCE):
        rows = _rows(some, beside, paths, range(first, min(first + _RUNS_AT_ONCE, len(beside))), sound)
        total = total + np.hstack(each(partial(np.matmul, rows.T), np.array_split(rows, 2, axis=1)))
    along = _along(known, np.delete(total[m:-1], np.s_[m:-1], axis=1))
    of = np.delete(np.delete(total, np.s_[m:-1], axis=0), np.s_[m:-1], axis=1) - along.T @ along
    absorbed = np.diag(of)[:m] < CRITERIA.discovery.absorbed * np.diag(total)[:m]
    products, with_residual = of[:m, :m].copy(), of[:m, m].copy()
    products[absorbed], products[:, absorbed], with_residual[absorbed] = 0.0, 0.0, 0.0
    left_out = lost + sum(not one for one, term in zip(sound, some, strict=True) if not term.free_shapes)
    return Regression(tuple(some), products, with_residual, float(of[m, m]), len(terms), left_out)


def _leading(
    terms: Sequence[Term], beside: Sequence[Regressors], paths: Mapping[str, Sequence[Response]], known: Array
) -> tuple[list[Term], int]:
    """The terms without free shapes, and the best single term of each form with free shapes.

    The second value is the number of terms with free shapes that are finite in no run.
    """
    shaped = [i for i, term in enumerate(terms) if term.free_shapes]
    candidates = [terms[i] for i in shaped]
    alone, sound = _alone(candidates, beside, paths, known)
    gains = np.round(alone, CRITERIA.discovery.digits)
    leading: dict[object, int] = {}
    for k, term in enumerate(candidates):
        if gains[k] > gains[leading.setdefault(term.form, k)]:
            leading[term.form] = k
    kept = {shaped[k] for k in leading.values()}
    return [term for i, term in enumerate(terms) if not term.free_shapes or i in kept], int(np.sum(~sound))


def _alone(
    terms: Sequence[Term], beside: Sequence[Regressors], paths: Mapping[str, Sequence[Response]], known: Array
) -> tuple[Array, NDArray[np.bool_]]:
    """The share of the residual's power that each of many terms takes off by itself, without products of two terms.

    The second value says of each term whether it is finite in any run.
    """
    cross, power = np.zeros((len(known), len(terms))), np.zeros(len(terms))
    finite = np.zeros(len(terms), dtype=bool)

    def sums(of: tuple[int, list[int]]) -> tuple[list[int], Array, Array, NDArray[np.bool_]]:
        run, here = of
        found, sound = beside[run].to([terms[i] for i in here], paths[terms[here[0]].path][run])
        return here, beside[run].known.T @ found, np.einsum("nt,nt->t", found, found), sound

    todo = [(run, here) for run in range(len(beside)) for here in batches(terms)]
    for here, of_known, of_itself, sound in each(sums, todo):
        cross[:, here] += of_known
        power[here] += of_itself
        finite[here] |= sound
    along = _along(known, np.column_stack([cross[:-1], known[:-1, -1]]))
    beyond = power - np.sum(along[:, :-1] ** 2, axis=0)
    with_residual = cross[-1] - along[:, :-1].T @ along[:, -1]
    seen = beyond >= CRITERIA.discovery.absorbed * power
    left = known[-1, -1] - along[:, -1] @ along[:, -1]
    return _gains(np.where(seen, beyond, 0.0), np.where(seen, with_residual, 0.0), left), finite


def _along(known: Array, cross: Array) -> Array:
    """Columns along orthonormal directions of J, from J's products with them, (p, m); `known` are products of [J,
    r]."""
    of = known[:-1, :-1]
    scale = np.sqrt(np.maximum(np.diag(of), TINY))
    strengths, directions = scipy.linalg.eigh(of / scale[:, None] / scale) if len(of) else (np.ones(0), of)
    seen = strengths > CRITERIA.evidence.dependent * strengths.max(initial=0.0)
    return np.asarray((directions[:, seen].T @ (cross / scale[:, None])) / np.sqrt(strengths[seen])[:, None])


def _gains(power: Array, with_residual: Array, left: float) -> Array:
    return _share(np.where(power > 0, with_residual**2 / np.maximum(power, TINY), 0.0), left)


def _share(taken: Array, left: float) -> Array:
    return np.asarray(taken / left if left > 0 else np.zeros_like(taken))


def _rows(
    terms: Sequence[Term],
    beside: Sequence[Regressors],
    paths: Mapping[str, Sequence[Response]],
    runs: Sequence[int],
    sound: NDArray[np.bool_],
) -> Array:
    """[T * φ, J, r] of some runs, one below the other; each batch of columns is put in its place, and held once.

    `sound` (terms,) becomes true for terms that are finite in one of these runs.
    """
    lengths = [len(beside[run].known) for run in runs]
    ends = dict(zip(runs, np.cumsum(lengths), strict=True))
    rows = np.empty((sum(lengths), len(terms) + beside[runs[0]].known.shape[1]))

    def filled(of: tuple[int, list[int]]) -> tuple[list[int], NDArray[np.bool_]]:
        run, here = of
        found, finite = beside[run].to([terms[i] for i in here], paths[terms[here[0]].path][run])
        rows[ends[run] - len(found) : ends[run], here] = found
        return here, finite

    for here, finite in each(filled, [(run, here) for run in runs for here in batches(terms)]):
        sound[here] |= finite
    for run in runs:
        known = beside[run].known
        rows[ends[run] - len(known) : ends[run], len(terms) :] = known
    return rows

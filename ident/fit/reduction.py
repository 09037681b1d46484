"""A run, reduced once to what eq. (17) needs of it for every linear model.

The response of a stable linear chain is a combination of the responses of a fixed set of rational filters (a
generalised orthonormal basis; Heuberger, Van den Hof, Wahlberg 2005). Each run's command is filtered once, sample by
sample from the start of the record, so that start and end are exact and nothing is periodic or windowed. What is kept
is a small matrix: with g = [Re G(jω_i), Im G(jω_i)] at fixed nodes ω_i,

    Σ_k (x_m − x)² = |W g − d|² + rest

holds for any model whose G the filters can represent; :meth:`Basis.doubt` says how far one is from that.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.fit.criteria import FIT_CRITERIA
from ident.linear import LinearModel
from ident.noise.power_density import power_density
from ident.parallel import each
from ident.rounding import EPSILON, TINY
from ident.run import Run
from ident.simulation.intersample_command import at_nodes
from ident.simulation.jit import jit
from ident.simulation.recursion import Recursion, discretise, responses

Array = NDArray[np.float64]

_OF, _BAND = FIT_CRITERIA.reduced, FIT_CRITERIA.band
_PAIRS = np.arange(_OF.pair_spacing / 2, _OF.pair_reach, _OF.pair_spacing)


@dataclass(frozen=True)
class Basis:
    """Filters and frequency nodes for commands with power up to `band` (rad/s)."""

    band: float

    @property
    def pairs(self) -> int:
        """The filters that come in pairs; they stand first."""
        return 2 * len(_PAIRS)

    @cached_property
    def filters(self) -> LinearModel:
        """m filters of two states: (s + σ)/D and ω/D for each pair, D = (s + σ)² + ω², and β/(s + β)."""
        sigma = _OF.pair_damping * self.band
        omega = _PAIRS * self.band
        beta = np.array(_OF.real) * self.band
        pairs, m = self.pairs, self.pairs + len(beta)
        A, B, C = np.zeros((m, 2, 2)), np.zeros((m, 2)), np.zeros((m, 2))
        A[:pairs, 0, 0] = A[:pairs, 1, 1] = -sigma
        A[:pairs, 0, 1], A[:pairs, 1, 0] = np.repeat(omega, 2), -np.repeat(omega, 2)
        B[:pairs, 0] = self.band
        C[0:pairs:2, 0] = C[1:pairs:2, 1] = 1.0
        A[pairs:, 0, 0], A[pairs:, 1, 1] = -beta, -self.band
        B[pairs:, 0], C[pairs:, 0] = beta, 1.0
        return LinearModel.of(A, B, C, np.zeros(m))

    @cached_property
    def nodes(self) -> Array:
        """Frequencies (rad/s) at which a model is evaluated: those that represent it, then those that check it."""
        fit = (np.arange(_OF.nodes) + 0.5) / _OF.nodes * _OF.node_reach
        check = (np.arange(_OF.checks) + _OF.first_check) / _OF.checks
        return np.concatenate([fit, check]) * self.band

    @cached_property
    def _at_nodes(self) -> NDArray[np.complex128]:
        return self.filters.frequency_response(self.nodes / (2 * np.pi)).T

    @cached_property
    def expansion(self) -> Array:
        """The filters' coefficients from the values at the nodes, (m, 2·nodes): least squares, the band counts most."""
        weight = np.where(self.nodes[: _OF.nodes] <= self.band, 1.0, _OF.beyond_band)
        F = self._at_nodes[: _OF.nodes] * weight[:, None]
        inverse = np.linalg.pinv(np.vstack([F.real, F.imag])) * np.tile(weight, 2)
        full = np.zeros((len(inverse), 2, len(self.nodes)))
        full[:, :, : _OF.nodes] = inverse.reshape(-1, 2, _OF.nodes)
        return full.reshape(len(inverse), -1)

    @cached_property
    def check(self) -> Array:
        """Rows that tell how far a model is from being represented, (2·checks, 2·nodes).

        Values of the expansion at the checking nodes minus the model's own: zero for a model it can represent.
        """
        F = self._at_nodes[_OF.nodes :]
        total = len(self.nodes)
        residual = np.vstack([F.real, F.imag]) @ self.expansion
        rows = np.arange(_OF.checks)
        residual[rows, _OF.nodes + rows] -= 1.0
        residual[_OF.checks + rows, total + _OF.nodes + rows] -= 1.0
        return residual


@dataclass(frozen=True)
class ReducedRun:
    """One run, reduced: W (r, 2·nodes), d (r,), `rest` and `total` = Σ (x_m − mean)², in the output's unit squared."""

    W: Array
    d: Array
    rest: float
    total: float

    @property
    def shown(self) -> float:
        """The share of the record's power that no first state explains: what of it tells models apart."""
        return float((self.d @ self.d + self.rest) / self.total)

    def errors(self, g: Array, basis: Basis) -> tuple[Array, Array]:
        """Eq. (17) of models given by their values at the nodes, (v, 2·nodes) → (v,), and their doubt.

        The doubt is how far a model is from being represented by the basis, relative to its size. Of a record that is
        little else than the decay of its first state it is infinite: the decays of all filters together explain it
        without a model, and a model has but its own.
        """
        errors, doubt = np.empty(len(g)), np.empty(len(g))
        _reduce(g, self.W, self.d, self.rest / self.total, 1.0 / self.total, basis.check, errors, doubt)
        if self.shown < _OF.shown:
            doubt[:] = np.inf
        return errors, doubt


@jit(fastmath=True, nogil=True)
def _reduce(g: Array, W: Array, d: Array, rest: float, unit: float, check: Array, errors: Array, doubt: Array) -> None:
    outputs, misfits = np.dot(g, W.T), np.dot(g, check.T)
    half, checks = g.shape[1] // 2, len(check)
    for v in range(len(g)):
        distance, misfit, size = 0.0, 0.0, TINY
        for row in range(len(d)):
            distance += (outputs[v, row] - d[row]) ** 2
        for row in range(checks):
            misfit += misfits[v, row] ** 2
        for k in range(checks // 2):  # the checking nodes stand last, real parts and imaginary parts
            size += g[v, half - 1 - k] ** 2 + g[v, 2 * half - 1 - k] ** 2
        errors[v] = np.sqrt(distance * unit + rest)
        doubt[v] = np.sqrt(misfit / size)


def excited_band(runs: Sequence[Run]) -> float:
    """The angular frequency (rad/s) up to which the commands excite the machine.

    1.25 times that below which every command has 99 % of its power: the rest may be the recorder's own noise, spread
    over all frequencies, and must not stretch the basis.
    """

    def edge(run: Run) -> float:
        segment = min(run.length, max(_BAND.shortest_window, run.length // _BAND.windows), _BAND.window)
        # A step has the power of what it steps to after as long at nothing.
        command = np.concatenate([np.zeros(run.length), run.command]) if run.stepped else run.command
        frequency, power = power_density(command, run.sample_rate, segment)
        share = np.cumsum(power)
        return float(frequency[max(1, np.searchsorted(share, _BAND.power * share[-1]))])

    edges = each(edge, runs)
    nyquist = max(run.sample_rate for run in runs) / 2
    return 2 * np.pi * min(_BAND.margin * max(edges), _BAND.most * nyquist)


def reduced(run: Run, basis: Basis) -> ReducedRun:
    """Reduce a run. What no model of the command can explain is projected out first: the mean and, in a record that
    starts moving, the decay of whatever state it started in."""
    columns, (gram, rounding) = len(basis.filters.D), _gram(run, basis)
    kept, nuisance = slice(0, columns + 1), slice(columns + 1, None)
    values, vectors = np.linalg.eigh(gram[nuisance, nuisance])
    sound = values > EPSILON * values[-1]
    projection = gram[kept, nuisance] @ (vectors[:, sound] / np.sqrt(values[sound]))
    mean_free = gram[columns, columns] - gram[columns, -1] ** 2 / gram[-1, -1]
    gram = gram[kept, kept] - projection @ projection.T
    values, vectors = np.linalg.eigh(gram[:columns, :columns])
    sound = values > max(_OF.rounding, rounding) * values[-1]
    root = np.sqrt(values[sound])
    d = (vectors[:, sound].T @ gram[:columns, columns]) / root
    # Rows of W that no model of ordinary size can make felt are dropped: their share of d is part of the rest.
    left, strength, right = np.linalg.svd((vectors[:, sound] * root).T @ basis.expansion, full_matrices=False)
    felt = strength > _OF.felt * strength[0]
    d = left[:, felt].T @ d
    W = strength[felt, None] * right[felt]
    return ReducedRun(W, d, max(float(gram[columns, columns] - d @ d), 0.0), float(mean_free))


def _gram(run: Run, basis: Basis) -> tuple[Array, float]:
    """Sums of products of [filtered command, record, decays from a moving start, 1], (q, q), and their relative error.

    Only the products of the filters with command, record and 1 are summed sample by sample; see :func:`_products`.
    """
    filters, command = _recursion(basis, run.sample_rate, run.hold), at_nodes(run)
    inputs = command.shape[1]
    if run.begins == "standing":
        filters = replace(filters, start=basis.filters.standing(run.command[0], 0.0))
    systems = filters.beside(_decays(filters)) if run.begins == "moving" else filters
    # The mean of a record would cost digits in the sums of squares, so it goes first; the model is blind to it anyway.
    measured = run.centred
    driven = np.vstack([command[:-1], np.zeros_like(command[:1])])  # what comes behind the last sample shows in none
    beside = np.column_stack([driven, measured, np.ones(run.length)])
    sums, last = np.zeros((len(systems.D), inputs + 2)), np.zeros(len(systems.D))
    for rows, begin, end in responses(systems, command):
        sums += (rows.T @ beside[begin:end])[: len(sums)]
        last = rows[-1, : len(sums)].copy()
    record = beside.T @ beside
    gram = np.block(
        [
            [_products(systems, sums, last, record, basis.pairs), sums[:, inputs:]],
            [sums[:, inputs:].T, record[inputs:, inputs:]],
        ]
    )
    columns, count = len(filters.D), len(systems.D)
    order = [*range(columns), count, *range(columns, count), count + 1]
    slowest = float(1.0 - np.abs(systems.phi[:, 0, 0]).max() ** 2)  # a filter's sums are divided by this
    return gram[np.ix_(order, order)], np.finfo(float).eps / slowest


@lru_cache(maxsize=2)
def _recursion(basis: Basis, sample_rate: float, hold: str) -> Recursion:
    """The filters in discrete time, the same for all runs of a rate. They take a third of the time of a reduction."""
    return discretise(basis.filters, sample_rate, hold)


def _products(systems: Recursion, sums: Array, last: Array, record: Array, pairs: int) -> Array:
    """Σ_k x_i[k] x_j[k] of n filters over a record of N samples in closed form, (n, n).

    Each is x = Re c of a complex filter of first order, c[k+1] = φ c[k] + w[k]: in a pair x_i is the
    real part of one and its partner the imaginary part, with a sign. The recursion, multiplied by that of another
    filter and summed over the samples, gives S = Σ c_i c_j from what is known:

        (1 − φi φj) S = ci[0] cj[0] − φi φj ci[N−1] cj[N−1] + φi Σ c_i w_j + φj Σ w_i c_j + Σ w_i w_j,

    w[k] = Σ γ u at the q nodes of sample k; the last three sums go to N − 2. Likewise with c_j conjugate; half the sum
    of both is the product of the real parts. `sums` (n, ≥q) are those of x with u at the nodes, `record` (≥q, ≥q) those
    of the command with itself.
    """

    def with_partner(x: Array) -> NDArray[np.complex128]:
        partner = np.zeros_like(x)
        for start in range(0, len(x), pairs + len(_OF.real)):  # the filters, then their decays
            even, odd = x[start : start + pairs : 2], x[start + 1 : start + pairs : 2]
            partner[start : start + pairs : 2], partner[start + 1 : start + pairs : 2] = -odd, even
        return x + 1j * partner

    def shown(states: Array) -> NDArray[np.complex128]:
        return with_partner(np.einsum("in,i...n->i...", systems.C, states))

    pole = systems.phi[:, 0, 0] - 1j * systems.phi[:, 1, 0]
    drive, inputs = shown(systems.gamma), systems.gamma.shape[1]
    start, end, driven = shown(systems.start), with_partner(last), with_partner(sums[:, :inputs])
    total = np.zeros((len(pole), len(pole)))
    for conjugate in (False, True):
        other = np.conj if conjugate else np.asarray
        through = np.outer(pole, other(pole))
        own = drive @ record[:inputs, :inputs] @ other(drive).T
        mixed = pole[:, None] * (driven @ other(drive).T) + other(pole) * (drive @ other(driven).T)
        known = np.outer(start, other(start)) - through * np.outer(end, other(end)) + mixed + own
        total += 0.5 * (known / (1.0 - through)).real
    return total


def _decays(filters: Recursion) -> Recursion:
    """The filters without input, released from their first state."""
    start = np.zeros_like(filters.start)
    start[:, 0] = 1.0
    return Recursion(filters.phi, np.zeros_like(filters.gamma), filters.C, filters.D, start)


def within(signal: Array, sample_rate: float, low: float | None, high: float | None) -> Array:
    """What a signal (n, ...) has between two frequencies in Hz, along its first axis, without any lag."""
    spectrum = scipy.fft.rfft(signal, axis=0)
    frequency = np.fft.rfftfreq(len(signal), 1 / sample_rate)
    spectrum[(frequency < (low or 0.0)) | (frequency > (np.inf if high is None else high))] = 0.0
    return np.asarray(scipy.fft.irfft(spectrum, len(signal), axis=0))

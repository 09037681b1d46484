"""Where the energy of residuals lies: in the harmonics of a periodic test, in fractions of an octave of any other.

A residual r (n,) of a run whose output has the standard deviation s is cut into parts that are orthogonal,

    r / s = Σ_b r_b,      E_b = Σ_t r_b²,      expected of white noise of variance f s²:  f d_b

with d_b the degrees of freedom of a band. The mean is a band of one. A test with a period of T samples (any real
number) has a band of two for each harmonic h / T, and one band for the part that does not repeat; other records have
bands of a quarter of an octave. Runs of one condition are pooled: a test which is cut in two, or repeated, stays one
test.

Not all degrees of freedom are distinct: a term that no model has repeats itself in every period, and in every sample of
a band. So d_b is at most 2 for a harmonic, however many periods were measured. c_b = 1 / (1/d_b + 1/α) degrees of
freedom are then distinct: nearly all of a few, at most α of many, as a coarsened likelihood counts samples (Miller and
Dunson 2019).
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA, EvidenceCriteria
from ident.rounding import EPSILON

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Indices = NDArray[np.intp]


@dataclass(frozen=True)
class Record:
    """The properties of a run that a comparison needs.

    `size` is the standard deviation of its output, in the output's unit. `condition` names the properties that differ
    between tests and not between repetitions of one test: amplitude, frequency, direction, specimen, sample rate.
    `period` is the period of a periodic test in samples, None for other tests. `floor` is the variance of the noise
    over size², None where it is not known.
    """

    size: float
    condition: Hashable = ""
    period: float | None = None
    floor: float | None = None


@dataclass(frozen=True)
class EnergyBands:
    """The bands of some runs, the same ones for all models: `lengths` (samples) and records, a run each."""

    records: tuple[Record, ...]
    lengths: tuple[int, ...]
    criteria: EvidenceCriteria = EVIDENCE_CRITERIA

    def __post_init__(self) -> None:
        if len(self.records) != len(self.lengths):
            raise ValueError(f"{len(self.records)} records, {len(self.lengths)} lengths")
        if not all(record.size > 0 for record in self.records):
            raise ValueError("a record has no power: its output does not move")

    @cached_property
    def degrees(self) -> Array:
        """d_b (bands,), summed over the runs of a condition."""
        return sum((run.degrees(self.size) for run in self.runs), np.zeros(self.size))

    @cached_property
    def distinct(self) -> Array:
        """c_b (bands,)."""
        lines = np.zeros(self.size, dtype=bool)
        for run in self.runs:
            lines[run.first : run.first + run.lines] = True
        degrees = np.where(lines, np.minimum(self.degrees, 2.0), self.degrees)
        degrees[[run.first for run in self.runs]] = 1.0  # the mean
        return np.asarray(1.0 / (1.0 / np.maximum(degrees, 1.0) + 1.0 / self.criteria.degrees_of_a_band))

    @cached_property
    def condition(self) -> Indices:
        """The condition of each band, (bands,), counted from 0."""
        found = np.zeros(self.size, dtype=np.intp)
        for run in self.runs:
            found[run.first : run.first + run.bands] = run.condition
        return found

    def white(self, variances: Array) -> Array:
        """The energies (bands,) of white noise whose variances (runs,) are over the power of each run's output."""
        return sum((f * of_run for f, of_run in zip(variances, self._by_run, strict=True)), np.zeros(self.size))

    @cached_property
    def _by_run(self) -> list[Array]:
        """The degrees of freedom of each run by band, (bands,)."""
        return [run.degrees(self.size) for run in self.runs]

    def energies(self, residuals: Sequence[Array]) -> Array:
        """E_b (bands,) of the residuals of all runs, in the outputs' unit."""
        return np.asarray(self.by_run(residuals).sum(axis=0))

    def by_run(self, residuals: Sequence[Array]) -> Array:
        """The energies of each run in each band, (runs, bands)."""
        found = np.zeros((len(self.records), self.size))
        for i, (run, residual, record) in enumerate(zip(self.runs, residuals, self.records, strict=True)):
            parts = run.coefficients(np.asarray(residual, dtype=np.float64)[:, None] / record.size)[:, 0]
            found[i] = np.bincount(run.band, np.abs(parts) ** 2, self.size)
        return found

    @cached_property
    def size(self) -> int:
        """The number of bands."""
        return max((run.first + run.bands for run in self.runs), default=0)

    @cached_property
    def runs(self) -> tuple[_Bands, ...]:
        """The bands of each run: runs of one condition have common bands."""
        groups: dict[tuple[Hashable, bool], list[int]] = {}
        for i, record in enumerate(self.records):
            groups.setdefault((record.condition, record.period is not None), []).append(i)
        found: dict[int, _Bands] = {}
        first = 0
        for number, members in enumerate(groups.values()):
            shortest = min(self.lengths[i] for i in members)
            edges = _edges(shortest, self.criteria)
            periods = [self.records[i].period for i in members]
            lines = min(
                (_harmonics(self.lengths[i], p, self.criteria) for i, p in zip(members, periods, strict=True) if p),
                default=0,
            )
            for i in members:
                period = self.records[i].period
                found[i] = (
                    _Periodic(self.lengths[i], number, first, period, lines)
                    if period
                    else _Broadband(self.lengths[i], number, first, edges / shortest)
                )
            first += found[members[0]].bands
        return tuple(found[i] for i in range(len(self.records)))


@dataclass(frozen=True)
class _Bands:
    """The bands of a run of n samples: `first` is the place of its first band among the bands of all conditions."""

    n: int
    condition: int
    first: int

    @property
    def bands(self) -> int:
        raise NotImplementedError

    @property
    def lines(self) -> int:
        """The number of its bands that are a mean or a harmonic."""
        return 1

    @cached_property
    def band(self) -> Indices:
        """The band of each of its coefficients among the bands of all conditions."""
        raise NotImplementedError

    def coefficients(self, signals: Array) -> Complex:
        """Orthogonal parts of signals (n, k): complex numbers (m, k) whose squares sum to the energy."""
        raise NotImplementedError

    def weighted(self, signal: Array, weights: Array) -> Array:
        """A signal (n,) whose energy in each band of all conditions is multiplied by its weight (bands,)."""
        raise NotImplementedError

    def degrees(self, count: int) -> Array:
        """Its degrees of freedom in each of the `count` bands of all conditions."""
        raise NotImplementedError

    def _counted(self, lines: Indices, count: int) -> Array:
        """Two degrees of freedom for each complex line, one for the mean."""
        weights = np.full(len(lines), 2.0)
        weights[0] = 1.0
        return np.asarray(np.bincount(lines, weights, count), dtype=np.float64)


@dataclass(frozen=True)
class _Broadband(_Bands):
    """A record that is not periodic: `edges` of its bands in cycles a sample."""

    edges: Array

    @property
    def bands(self) -> int:
        return len(self.edges)

    @cached_property
    def band(self) -> Indices:
        frequency = np.arange(self.n // 2 + 1) / self.n
        within = np.searchsorted(self.edges[1:], frequency * (1 + EPSILON), side="right")
        return np.asarray(self.first + within, dtype=np.intp)

    def coefficients(self, signals: Array) -> Complex:
        return _spectrum(signals)

    def weighted(self, signal: Array, weights: Array) -> Array:
        return np.asarray(np.fft.irfft(np.fft.rfft(signal) * np.sqrt(weights[self.band]), self.n))

    def degrees(self, count: int) -> Array:
        found = self._counted(self.band, count)
        found[self.band[-1]] -= 1.0 - self.n % 2  # the line at half the sample rate is real
        return found


@dataclass(frozen=True)
class _Periodic(_Bands):
    """A test with a `period` in samples: bands of the mean, of each harmonic, and of the part that does not repeat."""

    period: float
    harmonics: int

    @property
    def bands(self) -> int:
        return self.harmonics + 2

    @property
    def lines(self) -> int:
        return self.harmonics + 1

    @cached_property
    def band(self) -> Indices:
        remainder = np.full(self.n // 2 + 1, self.harmonics + 1)
        return np.asarray(self.first + np.concatenate([np.arange(self.harmonics + 1), remainder]), dtype=np.intp)

    @cached_property
    def _basis(self) -> Array:
        """An orthonormal basis of the mean and the harmonics, (n, 2 harmonics + 1), pair by pair."""
        phase = 2.0 * np.pi * np.arange(self.n)[:, None] / self.period * np.arange(1, self.harmonics + 1)
        waves = np.stack([np.cos(phase), np.sin(phase)], axis=2).reshape(self.n, 2 * self.harmonics)
        return np.asarray(np.linalg.qr(np.column_stack([np.ones(self.n), waves]))[0])

    def coefficients(self, signals: Array) -> Complex:
        shares = self._basis.T @ signals
        remainder = signals - self._basis @ shares
        parts = [shares[:1], shares[1::2] + 1j * shares[2::2], _spectrum(remainder)]
        return np.asarray(np.concatenate(parts), complex)

    def weighted(self, signal: Array, weights: Array) -> Array:
        shares, own = self._basis.T @ signal, np.sqrt(weights[self.first : self.first + self.bands])
        remainder = signal - self._basis @ shares
        return np.asarray(self._basis @ (shares * np.repeat(own[:-1], 2)[1:]) + own[-1] * remainder)

    def degrees(self, count: int) -> Array:
        found = self._counted(self.band[: self.harmonics + 1], count)
        found[self.first + self.harmonics + 1] = self.n - 2 * self.harmonics - 1
        return found


def _spectrum(signals: Array) -> Complex:
    """One-sided Fourier coefficients whose squares sum to the energy."""
    n = len(signals)
    found = np.asarray(np.fft.rfft(signals, axis=0), dtype=np.complex128) * np.sqrt(2.0 / n)
    found[0] /= np.sqrt(2.0)
    if n % 2 == 0:
        found[-1] /= np.sqrt(2.0)
    return np.asarray(found, dtype=np.complex128)


def _edges(n: int, criteria: EvidenceCriteria) -> Array:
    """The lines at which the bands of a record of n samples begin: the mean, then fractions of an octave."""
    edges, last = [0, 1], n // 2 + 1
    ratio = 2.0 ** (1.0 / criteria.bands_of_an_octave)
    while (end := max(edges[-1] + criteria.lines_of_a_band, int(edges[-1] * ratio) + 1)) <= last - 1:
        edges.append(end)
    if len(edges) > 2 and last - edges[-1] < criteria.lines_of_a_band:
        edges.pop()
    return np.array(edges, dtype=np.float64)


def _harmonics(n: int, period: float, criteria: EvidenceCriteria) -> int:
    """The number of harmonics of n samples: below half the sample rate, with a quarter of the degrees of freedom."""
    return max(1, min(criteria.harmonics, int(np.ceil(period / 2.0)) - 1, n // criteria.samples_of_a_harmonic))

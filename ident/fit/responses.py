"""How a fitted model's output answers to changes of many kinds, set beside its sensitivities.

The model is simulated once with each of its parameters moved, then with each change by itself. Of a change only its
products with the sensitivities and the residual are wanted, and its own power: never those of two changes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.fit.fitness import STEP
from ident.fit.products import CHUNK, removal, shares_of, without
from ident.fit.simulated_fitness import SimulatedFitness
from ident.parallel import each
from ident.run import Run
from ident.simulation.jit import jit

Array = NDArray[np.float64]
_LANES = 1024
"""Simulated in one go: what all of them share is worked out once. No answer depends on it."""
_LARGEST = 1e30
"""A sum of squares beyond it is of a model that ran away. No answer depends on it: one that grows so far overflows."""


@dataclass(frozen=True)
class Responses:
    """Products of n changes d of the output with [J, r] of each run, (runs, p+1, n), their power and means (runs, n).

    What is free in a record is taken off. A change that makes a run unstable has nothing but zeros there.
    """

    products: Array
    power: Array
    means: Array


@dataclass(frozen=True)
class _Columns:
    """Z = [J, N, 1, r] of a run, (q, samples), ZᵀZ, what takes N and 1 off J and r, (q, p+1), and Σ (x_m − mean)²."""

    Z: Array
    gram: Array
    remove: Array
    total: float


@dataclass(frozen=True)
class Sensitivities:
    """J, the sensitivities of a fitted model to its p parameters, and its residual r, at every run of a fitness.

    Kinks of effects are met at whole samples: for a first sight only.
    """

    fitness: SimulatedFitness
    strides: Array
    columns: Mapping[str, _Columns]

    @classmethod
    def of(cls, fitness: SimulatedFitness, point: Array) -> Sensitivities:
        """Simulate the model at a point (p,) of the search space and its neighbours, each with one parameter moved."""
        strides = np.where(point + STEP > 1.0, -STEP, STEP)  # inwards at a bound
        values = fitness.space.values(np.concatenate([point[None], point + np.diag(strides)]))
        steps = int(fitness.steps(values, kinks=False).max())
        fitness.begin({name: float(value[0]) for name, value in values.items()})

        def of_share(runs: tuple[Run, ...]) -> list[_Columns]:
            measured = np.array([run.centred for run in runs])
            released = fitness.released(runs, values, steps)
            Z = np.ones((len(runs), released.shape[1] + 1, runs[0].length))
            with np.errstate(over="ignore", invalid="ignore"):
                for rows, first, last in released.outputs():  # block by block: records may be long
                    outputs = rows.transpose(1, 2, 0)
                    Z[:, :-2, first:last] = outputs[:, 1:] - outputs[:, :1]
                    Z[:, -1, first:last] = measured[:, first:last] - outputs[:, 0]
                Z[:, : len(strides)] /= strides[:, None]
                if fitness.horizon is not None:
                    Z = fitness.shown(runs[0], Z.transpose(2, 0, 1)).transpose(1, 2, 0).copy()
                gram = Z @ Z.transpose(0, 2, 1)
                unsound = ~(np.diagonal(gram, axis1=1, axis2=2) < _LARGEST)
            Z[unsound] = 0.0
            gram[unsound] = 0.0
            gram.transpose(0, 2, 1)[unsound] = 0.0
            totals = np.sum(measured**2, axis=1)
            remove = removal(gram, len(strides), totals)
            return [_Columns(*parts) for parts in zip(Z, gram, remove, totals.tolist(), strict=True)]

        todo = list(fitness.together(len(strides) + 1 + len(fitness.chain.begun), steps))
        parts = zip(todo, each(of_share, todo), strict=True)
        columns = {run.id: found for runs, part in parts for run, found in zip(runs, part, strict=True)}
        return cls(fitness, strides, columns)

    def products(self) -> tuple[Array, Array]:
        """Σ of products of [J, r] of each run, (runs, p+1, p+1), and their means, (runs, p+1)."""
        found = [self.columns[run.id] for run in self.fitness.runs]
        means = np.array([-known.remove[-2] for known in found])
        if self.fitness.horizon is None:  # else each window begins anew, and no mean is left
            means[:, -1] += [run.mean for run in self.fitness.runs]
        return np.array([without(known.remove, known.gram) for known in found]), means

    def beside(self, fitness: SimulatedFitness, known: Mapping[str, float], values: Mapping[str, Array]) -> Responses:
        """The responses to n changes, each an entry (n,) of `values`; `known` are the model's own.

        The model is that of `fitness` there, on the same runs: it may hold more that is off at the known values.
        """
        fitness.begin(known)
        count, runs = len(next(iter(values.values()))), self.fitness.runs
        found = Responses(np.zeros((len(runs), len(self.strides) + 1, count)), *np.zeros((2, len(runs), count)))
        where = {run.id: i for i, run in enumerate(runs)}
        steps = fitness.steps(values, kinks=False)
        todo = [
            (share, np.flatnonzero(steps == level), int(level))
            for level in np.unique(steps)
            for share in fitness.together(1 + int(np.sum(steps == level)), int(level), _LANES)
        ]

        def of_share(share: tuple[tuple[Run, ...], NDArray[np.intp], int]) -> None:
            rows, columns = np.ix_(np.array([where[run.id] for run in share[0]]), share[1])
            lanes = {name: np.append(known[name], value[share[1]]) for name, value in values.items()}
            shown = fitness.outputs_of(fitness.simulation(share[0], lanes, share[2]))
            products, power, means = self._responses(share[0], len(share[1]), shown)
            found.products[rows, :, columns] = products.transpose(0, 2, 1)
            found.power[rows, columns], found.means[rows, columns] = power, means

        each(of_share, todo)
        return found

    def series_beside(
        self, fitness: SimulatedFitness, known: Mapping[str, float], values: Mapping[str, Array]
    ) -> dict[str, Array]:
        """The changes of the output themselves, (samples, n) of each run by its id; zero where a run is unstable."""
        fitness.begin(known)
        lanes = {name: np.append(known[name], value) for name, value in values.items()}
        steps = int(fitness.steps(values, kinks=False).max())
        found: dict[str, Array] = {}
        for runs in fitness.together(1 + len(next(iter(values.values()))), steps, _LANES):
            shown = fitness.outputs_of(fitness.simulation(runs, lanes, steps))
            with np.errstate(over="ignore", invalid="ignore"):
                rows = np.concatenate([part[:, :, 1:] - part[:, :, :1] for part, _, _ in shown])
                sound = np.sum(rows**2, axis=0) < _LARGEST
            rows = np.where(sound, rows, 0.0)
            found |= {run.id: rows[:, i] for i, run in enumerate(runs)}
        return found

    def _responses(
        self, runs: tuple[Run, ...], changes: int, shown: Iterable[tuple[Array, int, int]]
    ) -> tuple[Array, Array, Array]:
        """Products, power and means of so many changes at runs of a kind, from the blocks that are `shown` of them.

        The model itself is the first of the lanes.
        """
        known = [self.columns[run.id] for run in runs]
        Z = np.array([columns.Z for columns in known])
        cross = np.zeros((len(runs), Z.shape[1], changes))
        power = np.zeros((len(runs), changes))
        for rows, first, _ in shown:
            _add(rows, Z, first, cross, power)
        sound = power < _LARGEST  # false where it is not a number
        cross, power = np.where(sound[:, None], cross, 0.0), np.where(sound, power, 0.0)
        free = np.arange(len(self.strides), Z.shape[1] - 1)
        gram = np.array([columns.gram for columns in known])
        totals = np.array([columns.total for columns in known])
        shares = shares_of(gram[:, free[:, None], free], cross[:, free], totals)
        left = np.maximum(power - np.einsum("rkn,rkn->rn", shares, cross[:, free]), 0.0)
        remove = np.array([columns.remove for columns in known])
        return remove.transpose(0, 2, 1) @ cross, left, shares[:, -1]


@jit(fastmath=True, nogil=True)
def _add(rows: Array, Z: Array, begin: int, cross: Array, power: Array) -> None:
    """Add to `cross` (runs, q, n) and `power` (runs, n) what the changes d give over the samples of a block.

    `rows` (samples, runs, 1+n) holds the model's output, then the changed ones; `Z` (runs, q, samples) is that of whole
    records, of which the block begins at sample `begin`. The changes lie
    side by side in memory, and so they stay: a product of matrices sums them with what is read once.
    """
    samples, runs, lanes = rows.shape
    d = np.empty((CHUNK, lanes - 1))
    for run in range(runs):
        for first in range(0, samples, CHUNK):
            last = min(first + CHUNK, samples)
            for t in range(first, last):
                base = rows[t, run, 0]
                for j in range(lanes - 1):
                    change = rows[t, run, j + 1] - base
                    d[t - first, j] = change
                    power[run, j] += change * change
            sums = np.dot(np.ascontiguousarray(Z[run, :, begin + first : begin + last]), d[: last - first])
            for i in range(len(sums)):
                for j in range(lanes - 1):
                    cross[run, i, j] += sums[i, j]

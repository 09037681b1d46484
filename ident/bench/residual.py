"""The residuals of a model on all records as a function of some of its values, with their derivatives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.exact_response import CONSTANTS as EXACT
from ident.bench.model import CONSTANTS, DELAY, FAST, Model, Models
from ident.bench.natural_sizes import natural_sizes
from ident.bench.reduced_record import Observed
from ident.bench.response import products
from ident.bench.speed_table import SpeedTable
from ident.cached import cached_property
from ident.diagnosis.criteria import CRITERIA
from ident.effects.effect import Effect
from ident.fit.criteria import FIT_CRITERIA
from ident.parallel import cores, each
from ident.stages.bench import ZERO_SHIFT

Array = NDArray[np.float64]
_OF = BENCH_CRITERIA.fits
STEP = FIT_CRITERIA.refinement.stride
BLOCKS = CRITERIA.cross_validation.stretches
"""Of a record: each is one sample of the score, and they take turns in being held out."""


@dataclass(frozen=True, eq=False)
class Residual:
    """The residual of a model on records as a function of some of its values.

    A point holds log(value / first) of what is positive (or negative, for speeds back), value / size of what may be 0.
    """

    model: Model
    observed: tuple[Observed, ...]
    names: tuple[str, ...]
    any_sign: frozenset[str] = frozenset()
    """Strengths of one sign that may take either here: a check that is blind to one side of nothing is biased."""

    @cached_property
    def _shares(self) -> list[list[int]]:
        """Numbers of the records for each core, the longest dealt out first: handing over one by one costs more."""
        order = sorted(range(len(self.observed)), key=lambda i: -self.observed[i].record.length)
        return [share for core in range(cores()) if (share := order[core :: cores()])]

    @property
    def origin(self) -> Array:
        """The point of the first model."""
        return np.array([self._first[n] / self.reach[n] if n in self.reach else 0.0 for n in self.names])

    @cached_property
    def _first(self) -> dict[str, float]:
        return dict.fromkeys(self.reach, 0.0) | self.model.values()

    @cached_property
    def reach(self) -> dict[str, float]:
        """The natural sizes of what may be zero or negative; all else is positive and moved by a share of itself."""
        sizes = natural_sizes(self.model, [one.record for one in self.observed])
        may_be_zero = [ZERO_SHIFT, *(parameter for effect in self._effects for parameter in effect.added)]
        return {p.in_equations: sizes.get(p.start, _OF.natural * (p.upper - p.lower)) for p in may_be_zero}

    @property
    def _effects(self) -> tuple[Effect, ...]:
        return (*FAST, *(self.model.chain.effects if self.model.chain is not None else ()))

    @cached_property
    def within(self) -> tuple[Array, Array]:
        """Bounds of each axis: a strength of one sign keeps it."""
        added = (parameter for effect in self._effects for parameter in effect.added)
        lower = {
            p.in_equations: p.lower / self.reach[p.in_equations]
            for p in added
            if p.lower >= 0 and p.in_equations not in self.any_sign
        }
        return np.array([lower.get(name, -np.inf) for name in self.names]), np.full(len(self.names), np.inf)

    def values(self, points: Array) -> dict[str, Array]:
        """The values at points: (v, p) → name: (v,)."""

        def value(name: str, place: Array) -> Array:
            if name in self.reach:
                return place * self.reach[name]
            return self._first[name] * np.exp(np.clip(place, -_OF.farthest, _OF.farthest))

        return {name: value(name, place) for name, place in zip(self.names, points.T, strict=True)}

    def at(self, point: Array) -> Model:
        """The model at a point."""
        return self.model.with_values({name: float(value[0]) for name, value in self.values(point[None]).items()})

    def of_records(self, point: Array) -> list[Array]:
        """The scaled residual of each record."""
        model = self.at(point)
        return [observed.residual(model) for observed in self.observed]

    def __call__(self, point: Array) -> Array:
        """All of them in one vector."""
        return np.concatenate(self.of_records(point))

    def cost(self, point: Array) -> float:
        """The sum of squares."""
        model = self.at(point)
        return sum(float(np.sum(observed.residual(model) ** 2)) for observed in self.observed)

    def slopes(self, point: Array, observed: Observed) -> tuple[Array, Array]:
        """The derivatives of a record's residual, (p, k), and the residual, (k,)."""
        found = self._exact(point, observed)
        if found is not None:
            model, moves, scales = found
            rows = observed.slopes(model, moves)
            return self._ordered(rows, scales), rows[0]
        seen, every = self._seen(point, observed)
        rows = observed.residuals(every)
        return self._spread(rows, seen), rows[0]

    def ways(self, point: Array, observed: Observed) -> tuple[Array, Array]:
        """The position of a record sample by sample, m, (n,), and its derivatives, (p, n)."""
        found = self._exact(point, observed)
        if found is not None:
            model, moves, scales = found
            rows = observed.ways(model, moves)
            return rows[0], self._ordered(rows, scales)
        seen, every = self._seen(point, observed)
        way = np.array([observed.way(model) for model in every.each])
        return way[0], self._spread(way, seen)

    def _exact(self, point: Array, observed: Observed) -> tuple[Model, Array, list[tuple[int, int, float]]] | None:
        """What the exact simulation of a record needs for its derivatives; None where differences have to do.

        The model, what each value of the table that the record sees adds to its pieces, and for each name that it sees
        its place among the names, its row, and by what that is multiplied for a derivative along the point's axis.
        """
        if observed.readings is None or not self._differentiable:
            return None
        model, moves = self._here(point)
        seen = np.flatnonzero(observed.reach + abs(model.I0) > self._limits(model)[1:])
        half, values = len(model.table.fractions), model.values()
        places = {name: divmod(place, half) for place, name in enumerate(model.table.names)}
        nodes = 1 + max((places[self.names[i]][1] for i in seen if self.names[i] in places), default=-1)
        found = []
        for i in seen:
            name = self.names[i]
            if name in places:
                side, node = places[name]
                found.append((int(i), 1 + EXACT + side * nodes + node, 1.0))
            elif name == DELAY:
                found.append((int(i), EXACT, self.reach[name] * observed.record.rate))
            else:
                found.append((int(i), 1 + CONSTANTS.index(name), self.reach.get(name, values[name])))
        return model, moves[:nodes], found

    @cached_property
    def is_exact(self) -> bool:
        """Whether every record is simulated exactly, with its derivatives; else they are differences."""
        return self._differentiable and all(observed.readings is not None for observed in self.observed)

    @cached_property
    def _differentiable(self) -> bool:
        return self.model.is_plain and {*self.names} <= {*CONSTANTS, *self.model.table.names, DELAY}

    @cached_property
    def _known(self) -> dict[bytes, tuple[Model, Array]]:
        return {}

    def _here(self, point: Array) -> tuple[Model, Array]:
        """The model at a point, and what each value of its table adds to the pieces, (nodes, sides, pieces, 4)."""
        key = point.tobytes()
        if key not in self._known:
            model = self.at(point)
            table, half, values = model.table, len(model.table.fractions), model.table.values()
            moves = np.zeros((half, 2, *table.pieces.shape[1:]))
            for place, name in enumerate(table.names):
                side, node = divmod(place, half)
                moved = table.with_values({name: values[name] * np.exp(STEP)})
                moves[node, side] = (moved.pieces[side] - table.pieces[side]) / STEP
            self._known.clear()
            self._known[key] = model, moves
        return self._known[key]

    def _ordered(self, rows: Array, scales: list[tuple[int, int, float]]) -> Array:
        """Rows of the exact simulation as derivatives along the axes, (p, n); zero for what the record does not see."""
        out = np.zeros((len(self.names), rows.shape[1]))
        for place, row, scale in scales:
            np.multiply(rows[row], scale, out=out[place])
        return out

    def _seen(self, point: Array, observed: Observed) -> tuple[NDArray[np.intp], Models]:
        """The models of :meth:`_moved` that a record tells apart, and their places."""
        every = self._moved(point)
        seen = np.flatnonzero(observed.reach + abs(every.each[0].I0) > self._limits(every.each[0]))
        return seen, every.some(seen)

    def _spread(self, rows: Array, seen: NDArray[np.intp]) -> Array:
        """Differences from the first row over the strides, a row a value; zero for what the record does not see."""
        out = np.zeros((len(self.names), rows.shape[1]))
        out[seen[1:] - 1] = (rows[1:] - rows[0]) / self._strides[seen[1:] - 1, None]
        return out

    def _limits(self, here: Model) -> Array:
        """The current from which on each of :meth:`_moved` acts."""
        return np.array([-1.0, *(_seen_from(here.table, name) for name in self.names)])

    @cached_property
    def _strides(self) -> Array:
        """By how much each axis is moved for a derivative: far along what acts in jumps, as its effect says."""
        far = {
            (p := effect.added[0]).in_equations: effect.stride * (p.upper - p.lower) / self.reach[p.in_equations]
            for effect in self._effects
            if effect.stride > STEP
        }
        return np.array([far.get(name, STEP) for name in self.names])

    def _moved(self, point: Array) -> Models:
        """The model at a point, then with each value moved by its stride."""
        return Models.of([self.at(point), *(self.at(moved) for moved in point + np.diag(self._strides))])

    def normal(self, point: Array) -> Normal:
        """The sum of squares with its derivatives; what a record cannot see is not computed."""
        exact = self.is_exact
        every, strides = (Models.of([self.at(point)]) if exact else self._moved(point)), self._strides
        here, size = every.each[0], len(self.names) + 1
        limits = self._limits(here)
        if exact:
            self._here(point)

        def one(observed: Observed, room: Array) -> tuple[int, Array]:
            found = self._exact(point, observed) if exact else None
            if found is not None:
                model, moves, scales = found
                all_rows = observed.slopes(model, moves)
                rows = np.array([*(all_rows[row] * scale for _, row, scale in scales), all_rows[0]])
                return all_rows.shape[1], _summed(rows, np.array([*(place for place, _, _ in scales), size - 1]), size)
            seen = np.flatnonzero(observed.reach + abs(here.I0) > limits)
            rows = observed.residuals(every.some(seen), room)
            base = rows[0].copy()
            rows[:-1] = (rows[1:] - base) / strides[seen[1:] - 1, None]
            rows[-1] = base
            return len(base), _summed(rows, np.append(seen[1:] - 1, size - 1), size)

        def of_share(share: list[int]) -> list[tuple[int, tuple[int, Array]]]:
            # One piece of memory for all of them: fresh memory would cost more than the simulation.
            room = np.empty(len(every) * max(self.observed[i].count for i in share))
            return [(i, one(self.observed[i], room)) for i in share]

        shares = each(of_share, self._shares)
        found = [part for _, part in sorted((pair for share in shares for pair in share), key=lambda pair: pair[0])]
        return Normal(np.concatenate([products for _, products in found]), sum(count for count, _ in found))


@dataclass(frozen=True, eq=False)
class Normal:
    """Products of [J, r] of blocks of neighbouring samples, (blocks, p + 1, p + 1), of `count` samples in all."""

    products: Array
    count: int

    @cached_property
    def _sum(self) -> Array:
        return np.asarray(self.products.sum(axis=0))

    @property
    def error(self) -> float:
        """Σ r²."""
        return float(self._sum[-1, -1])

    @property
    def gradient(self) -> Array:
        """2 Jᵀ r, (p,)."""
        return np.asarray(2.0 * self._sum[:-1, -1])

    @property
    def curvature(self) -> Array:
        """2 Jᵀ J, (p, p)."""
        return np.asarray(2.0 * self._sum[:-1, :-1])

    @property
    def scores(self) -> Array:
        """The parts of the gradient that the blocks make, (blocks, p)."""
        return np.asarray(2.0 * self.products[:, :-1, -1])


def _summed(rows: Array, places: NDArray[np.intp], size: int) -> Array:
    """The products of rows, block by block, at their places of (blocks, size, size)."""
    found = np.empty((BLOCKS, len(rows), len(rows)))
    products(rows, BLOCKS, found)
    out = np.zeros((BLOCKS, size, size))
    out[:, places[:, None], places] = found
    return out


def _seen_from(table: SpeedTable, name: str) -> float:
    """The current from which on a value acts: of a monotone table, two nodes before its own."""
    if name not in table.names:
        return -1.0
    place = table.names.index(name) % len(table.fractions)
    return float(table.nodes[max(0, place - 1)])

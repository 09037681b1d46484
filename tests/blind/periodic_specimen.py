"""The fits to a moved specimen's force without noise: strengths are linear, so only the shapes are searched."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize, nnls

from tests.blind.periodic import Moved, Test, specimen_term
from tests.blind.periodic_candidates import FASTEST

Array = NDArray[np.float64]
_POINTS = 1500  # samples that are fitted


@dataclass(frozen=True)
class Specimen:
    """The fits to a specimen's force: strengths are linear, so only the shapes are searched."""

    test: Test

    @cached_property
    def samples(self) -> NDArray[np.int64]:
        """All samples of the first two periods, and some of the others."""
        n = self.test.fitted
        first = min(int(2 * self.test.samples), _POINTS // 2, n)
        rest = np.random.default_rng(0).permutation(np.arange(first, n))[: _POINTS - first]
        return np.sort(np.concatenate([np.arange(first), rest]))

    @cached_property
    def weights(self) -> Array:
        """By how many samples each counts."""
        n = self.test.fitted
        first = min(int(2 * self.test.samples), _POINTS // 2, n)
        rest = max(len(self.samples) - first, 1)
        return np.where(self.samples < first, 1.0, (n - first) / rest)

    @cached_property
    def path(self) -> Moved:
        return self.test.path(self.samples)

    @cached_property
    def _root(self) -> Array:
        return np.sqrt(self.weights) / self.test.sigma

    @cached_property
    def _target(self) -> Array:
        return self._root * self.test.truth[self.samples]

    def d2(self, name: str, enough: float) -> float:
        """What the best fit with an effect leaves; the search ends where it is enough."""
        if name == "":
            return self._left(self._base(self.path.x), None)
        shapes = [*self._grid(name), *([self._true()] if name == self.test.hidden else [])]
        refined = sorted(((self._with(name, shape), shape) for shape in shapes), key=lambda one: one[0])
        best = refined[0][0]
        for _, shape in refined[:3] if len(refined[0][1]) else ():
            if best > enough:
                found = minimize(
                    lambda p: self._with(name, p),
                    shape,
                    method="Nelder-Mead",
                    options={"maxfev": 120, "xatol": 1e-4, "fatol": 0.1, "initial_simplex": _simplex(shape)},
                )
                best = min(best, float(found.fun))
        return best

    def _grid(self, name: str) -> Iterator[Array]:
        if name == "stribeck_friction":
            yield from (np.array([p]) for p in np.linspace(np.log(3e-3), np.log(FASTEST), 24))
        elif name == "presliding_friction":
            yield from (np.array([p]) for p in np.linspace(np.log(3e-4), np.log(5.0), 28))
        elif name == "specimen_hysteresis":
            for xy, n in product(np.linspace(np.log(3e-3), np.log(5.0), 16), np.log([1.0, 1.7, 3.0, 5.0])):
                yield np.array([xy, n])
        elif name == "specimen_free_play":
            yield from (np.array([p]) for p in np.linspace(np.log(3e-3), np.log(0.95), 24))
        elif name == "end_stop":
            yield from (np.array([p, 0.0]) for p in np.linspace(np.log(0.3), np.log(0.999), 24))
        else:
            yield np.array([])

    def _true(self) -> Array:
        """The shape of what is hidden."""
        law, x, v = self.test.law, *(float(np.abs(one).max()) for one in (self.path.x, self.path.v))
        shape: dict[str, tuple[float, ...]] = {
            "stribeck_friction": (law.stribeck_friction_vs / v,),
            "presliding_friction": (law.presliding_friction_xs / x,),
            "specimen_hysteresis": (law.specimen_hysteresis_xy / x, law.specimen_hysteresis_n),
            "specimen_free_play": (self.test.free_play / x,),
        }
        if self.test.hidden == "end_stop":
            return np.array([np.log(law.end_stop_way / x), 0.0])
        return np.log(shape.get(self.test.hidden, ()))

    def _with(self, name: str, shape: Array) -> float:
        """The least that is left with an effect of that shape; shapes outside of their bounds leave all."""
        x, v = (float(np.abs(one).max()) for one in (self.path.x, self.path.v))
        if name == "specimen_free_play":
            play = float(np.exp(shape[0])) * x
            if play >= x:
                return np.inf
            return self._left(self._base(self.path.x - np.clip(self.path.x, -play, play)), None)
        if name == "specimen_hysteresis" and not -1e-9 <= shape[1] <= np.log(5.0) + 1e-9:
            return np.inf
        if name == "end_stop" and abs(shape[1]) > 0.3:
            return np.inf
        if name == "stribeck_friction" and shape[0] > np.log(FASTEST) + 1e-9:
            return np.inf
        values = [float(np.exp(p)) for p in shape]
        of = {
            "stribeck_friction": lambda: {"vs": values[0] * v},
            "presliding_friction": lambda: {"xs": values[0] * x},
            "specimen_hysteresis": lambda: {"xy": values[0] * x, "n": max(values[1], 1.0)},
            "end_stop": lambda: {"way": values[0] * x, "xm": float(shape[1]) * x},
        }.get(name, dict)()
        return self._left(self._base(self.path.x), specimen_term(name, of, self.path), name == "cubic_stiffness")

    def _base(self, stretch: Array) -> list[Array]:
        return [self.path.v, stretch, self.path.a, np.ones(len(stretch)), -np.ones(len(stretch))]

    def _left(self, columns: list[Array], term: Array | None, both: bool = False) -> float:
        """The squares left by columns whose factors are not negative; the offset is free, and what may be negative."""
        if term is not None:
            columns = [*columns, term, *([-term] if both else [])]
        table = np.array(columns)
        size = np.sqrt(np.mean(table**2, axis=1))
        table = table[size > 0] / size[size > 0, None] * self._root
        reduced = np.linalg.qr(np.column_stack([table.T, self._target]), mode="r")
        _, left = nnls(reduced[:-1, :-1], reduced[:-1, -1])
        return float(left**2 + reduced[-1, -1] ** 2)


def _simplex(shape: Array) -> Array:
    """Where a search about a shape begins."""
    return np.vstack([shape, *(shape + 0.15 * step for step in np.eye(len(shape)))])

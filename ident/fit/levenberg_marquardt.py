"""Levenberg-Marquardt within bounds: from a start to the optimum near it, for every objective there is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from ident.fit.criteria import FIT_CRITERIA
from ident.fit.straight_steps import led
from ident.rounding import EPSILON, TINY

Array = NDArray[np.float64]
_OF = FIT_CRITERIA.refinement
STEPS = _OF.steps


class Shape(Protocol):
    """An objective and its local shape at one point: its gradient, (p,), and its Gauss-Newton matrix, (p, p)."""

    @property
    def error(self) -> float:
        """What is to be least."""
        ...

    @property
    def gradient(self) -> Array:
        """Its derivatives."""
        ...

    @property
    def curvature(self) -> Array:
        """Its second derivatives, but for those of the residuals."""
        ...


S = TypeVar("S", bound=Shape)


@dataclass(frozen=True)
class Way:
    """How far to go.

    `converged` is the relative decrease of the error below which no further step is worth it, `most` the number of
    steps, `within` the bounds of every axis or of each, `longest` the longest step along one. Below a promise of
    `rough` the error is not smooth: a step that failed and promised less is the last one. Who has to come below `aim`
    to be of any use gives up where neither the last steps nor the next one's promise come anywhere near it. `enough` is
    the error at which there is no need to go on.
    """

    converged: float = _OF.converged
    most: int = STEPS
    within: tuple[float | Array, float | Array] = (0.0, 1.0)
    longest: float = np.inf
    rough: float = 0.0
    aim: float = np.inf
    enough: float = -np.inf

    def is_lost(self, error: float, promised: float, *gained: float) -> bool:
        """Whether what is missing is many times what the next step promises, and what the last ones `gained`."""
        return error - self.aim > _OF.hope * max((promised, *gained))

    def promised(self, point: Array, here: Shape, spans: Array | None = None) -> float:
        """By how much the first step from a point lowers the error, were the model straight."""
        return promise(here, _trial(point, here, _OF.damping, self, _spans(point, spans))[0])

    def leads_nowhere(self, point: Array, here: Shape, spans: Array | None = None) -> bool:
        """Whether from a point that steps have led to the next one promises nothing near what is missing.

        Of a step that is cut at a bound nobody knows: a shorter one may promise more.
        """
        step, _, cut = _trial(point, here, _OF.damping, self, _spans(point, spans))
        return not cut and self.is_lost(here.error, promise(here, step))


def levenberg_marquardt(
    evaluate: Callable[[Array], S],
    start: Array,
    way: Way | None = None,
    report: Callable[[int, float], None] = lambda _count, _error: None,
    accept: Callable[[S], None] = lambda _here: None,
    better: Callable[[Array, float], S | None] | None = None,
    spans: Array | None = None,
) -> tuple[Array, S]:
    """The point with the least error near `start`, and the objective there.

    A step solves (H + λ diag H) δ = −g on the axes that are free: those at a bound with a gradient that points
    outwards stay. λ falls by as much as a step kept what it promised, at most tenfold, and rises twofold after one that
    did not help, fourfold after the next, and so on (Nielsen 1999): along a curved valley, where one λ serves for many
    steps, every other step failed that was a fixed factor longer. A step next to one that failed is taken for failed.
    `report` is told the number of steps and the error, `accept` of each point that is gone on from; `better` is the
    objective at a point where it is less than so far, where it costs less to tell that it is not. `spans` (p,) are
    ln(upper/lower) of the axes that are logarithmic, 0 of others: steps along these are straight in the parameter, see
    :mod:`ident.fit.straight_steps`.
    """
    spans = _spans(start, spans)
    way, better = way or Way(), better or partial(_better, evaluate)
    point, here, damping, rise = start.copy(), evaluate(start), _OF.damping, 2.0
    gained: list[float] = []
    failed: Array | None = None
    straight = False
    accept(here)
    for count in range(way.most):
        report(count, here.error)
        step, trial, cut = _trial(point, here, damping, way, spans)
        promised = promise(here, step)
        # A step cut at a bound may promise nothing where a shorter one does.
        if not promised > way.converged * here.error and not cut:
            break
        told = () if straight and not cut else gained[-2:]  # what else than its promise a step may take off
        if here.error <= way.enough or (len(told) != 1 and gained and way.is_lost(here.error, promised, *told)):
            break
        new = promised > 0 and not (failed is not None and _is_near(step, failed, here))
        there = better(trial, here.error) if new else None
        failed = step if new else failed
        if there is not None:
            gained.append(here.error - there.error)
            straight = damping <= _OF.damping and abs(gained[-1] / promised - 1.0) < _OF.kept
            damping, rise = max(damping * _fall(gained[-1] / promised), EPSILON), 2.0
            point, here, failed = trial, there, None
            accept(here)
        elif damping > _OF.most_damping or 0 < promised < way.rough * here.error:
            break
        else:
            damping, rise = damping * rise, 2.0 * rise
    return point, here


def promise(here: Shape, step: Array) -> float:
    """By how much a step lowers the error, were the model straight."""
    return -float(here.gradient @ step + 0.5 * step @ here.curvature @ step)


def _is_near(step: Array, failed: Array, here: Shape) -> bool:
    """Whether a step is next to one that failed at the same point: as far as H tells, it leads to the same."""
    size = np.sqrt(np.maximum(np.diag(here.curvature), 0.0))
    return bool(np.linalg.norm(size * (step - failed)) < _OF.near * np.linalg.norm(size * failed))


def _fall(kept: float) -> float:
    """By what the damping is multiplied after a step that kept a share of its promise (Nielsen 1999).

    By more than one below half.
    """
    return max(_OF.fall, 1.0 - (2.0 * kept - 1.0) ** 3)


def _better(evaluate: Callable[[Array], S], trial: Array, least: float) -> S | None:
    """The objective at a trial where it is less than so far."""
    there = evaluate(trial)
    return there if there.error < least else None


def _spans(point: Array, spans: Array | None) -> Array:
    """Those of linear axes, where none are given."""
    return np.zeros(len(point)) if spans is None else spans


def _trial(point: Array, here: Shape, damping: float, way: Way, spans: Array) -> tuple[Array, Array, bool]:
    """A step within the bounds, where it leads, and whether it was cut at one."""
    free_step = np.clip(_step(point, here, damping, way.within), -way.longest, way.longest)
    step, trial = led(point, free_step, *way.within, spans)
    return step, trial, bool(np.any(step != free_step))


def _step(point: Array, here: Shape, damping: float, within: tuple[float | Array, float | Array]) -> Array:
    step = np.zeros_like(point)
    lower, upper = within
    outwards = ((point <= lower) & (here.gradient > 0)) | ((point >= upper) & (here.gradient < 0))
    free = np.flatnonzero(~outwards)
    if len(free):
        H = here.curvature[np.ix_(free, free)]
        scale = np.sqrt(np.maximum(np.diag(H), EPSILON * max(np.diag(H).max(), TINY)))
        scaled = H / scale[:, None] / scale
        np.fill_diagonal(scaled, 1.0 + damping + EPSILON)
        step[free] = -np.linalg.solve(scaled, here.gradient[free] / scale) / scale
    return step

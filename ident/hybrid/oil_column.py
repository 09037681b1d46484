"""What would have to change for the response to have a peak at a frequency: one parameter, or all of them together.

The size of a change is √Σ (ln factor)², whatever the parameters' units are. The smallest is sought from random
starts by sequential quadratic programming (scipy's SLSQP); it is one of many, so the range of each parameter over
all changes up to a tenth larger is sought as well.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy  # optimize, which takes a third of a second to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.fit.result import Starts
from ident.hybrid.changed_machine import ChangedMachine
from ident.hybrid.peak_problem import PeakProblem, PeakTarget, free_parameters
from ident.hybrid.peaks import Peak
from ident.plain import written
from ident.progress import Progress, Report, silent
from ident.words.message import message
from ident.words.number import trimmed

Array = NDArray[np.float64]
WIDEST = float(np.log(100.0))
"""Of a change: a parameter becomes at most 100 times as large or as small."""
AS_GOOD = 1.1
"""A change that is at most this many times as large as the smallest does as well."""
STARTS = 12
_SCANNED = 401  # factors of one parameter, evenly in their logarithm
_COARSE = 160  # frequencies at which these are judged
_AGREE = 1.001  # times the smallest: the same
_FAR = 0.7  # of ln factor: the spread of the starts


@dataclass(frozen=True)
class JointChange:
    """Factors of the parameters by name, √Σ (ln factor)², and the peak at each gain (Hz, |G|)."""

    factors: Mapping[str, float]
    size: float
    peaks: tuple[Peak, ...]


@dataclass(frozen=True)
class FactorRange:
    """Between what the factor of a parameter lies over all changes that do as well, with the change at either end."""

    lower: float
    upper: float
    at_lower: JointChange
    at_upper: JointChange


@dataclass(frozen=True)
class PeakSearch:
    """What puts a peak at the target. `singles` has the factor of each parameter that does so alone, None for none.

    `smallest` is None where nothing was found. `others` are the ranges of the factors over all changes of size up to
    `AS_GOOD` times the smallest.
    """

    target: PeakTarget
    already: bool
    singles: Mapping[str, float | None]
    smallest: JointChange | None
    others: Mapping[str, FactorRange]
    starts: Starts | None
    seed: int
    text: tuple[str, ...]

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data."""
        data: dict[str, Any] = written(self)
        return data


def find_peak(
    machine: ChangedMachine, target: PeakTarget, seed: int = 0, starts: int = STARTS, report: Report = silent
) -> PeakSearch:
    """The smallest change of a machine's parameters that puts a peak at the target, stable at each of its gains."""
    names = free_parameters(machine)
    problem = PeakProblem(machine, target, names)
    already = problem.judged(np.zeros(len(names))) is not None
    singles = {name: _alone(problem, i) for i, name in enumerate(names)}
    found = [] if already else _smallest(problem, seed, starts, report)
    best = found[0] if found else None
    others = {} if best is None else dict(_ranges(problem, found, report))
    smallest = None if best is None else _named(problem, best)
    if smallest is not None and others:
        ends = [end for r in others.values() for end in (r.at_lower, r.at_upper)]
        smallest = min([smallest, *ends], key=lambda change: change.size)
    agree = sum(_size(problem, x) <= _AGREE * _size(problem, found[0]) for x in found)
    tried = None if already else Starts(starts, agree)
    text = tuple(_words(target, already, singles, smallest, others, tried))
    return PeakSearch(target, already, singles, smallest, others, tried, seed, text)


def _alone(problem: PeakProblem, i: int) -> float | None:
    """The factor nearest to 1 with which one parameter alone does it, among those scanned; None where none does."""
    z = np.zeros((_SCANNED, len(problem.names)))
    z[:, i] = np.linspace(-WIDEST, WIDEST, _SCANNED)
    end = max(problem.target.frequency + problem.target.tolerance, problem.target.up_to)
    frequency = np.linspace(0, 1.2 * end, _COARSE + 1)[1:]
    L, growth = problem.levels(z, frequency)
    for at in np.argsort(np.abs(z[:, i]), kind="stable"):
        if problem.fits(frequency, L[at], growth[at]) is not None and problem.judged(z[at]) is not None:
            return float(np.exp(z[at, i]))
    return None


def _smallest(problem: PeakProblem, seed: int, starts: int, report: Report) -> list[Array]:
    """Every solution that was found, x, the smallest first."""
    rng, found = np.random.default_rng(seed), []
    n, g = len(problem.names), len(problem.gains)
    f0 = np.log(problem.target.frequency)
    for start in range(starts):
        report(Progress("peak", start, starts))
        spread = _FAR * (0.3 + 1.2 * start / starts)
        x = np.concatenate([spread * rng.standard_normal(n), np.full(g, f0), np.full(g, f0 - 0.4)])
        solved = _solved(problem, x, _squares(n))
        if solved is not None:
            found.append(solved)
    report(Progress("peak", starts, starts))
    return sorted(found, key=lambda x: float(np.linalg.norm(x[:n])))


def _solved(problem: PeakProblem, x: Array, cost: Any, further: Sequence[Mapping[str, Any]] = ()) -> Array | None:
    """Where SLSQP ends from x; None where that does not put a peak at the target."""
    conditions = [
        {"type": "eq", "fun": lambda x: problem.equal(x)[0], "jac": lambda x: problem.equal(x)[1]},
        {"type": "ineq", "fun": lambda x: problem.least(x)[0], "jac": lambda x: problem.least(x)[1]},
        *further,
    ]
    with np.errstate(all="ignore"):
        ended = scipy.optimize.minimize(
            cost,
            x,
            jac=True,
            method="SLSQP",
            bounds=problem.bounds(WIDEST),
            constraints=conditions,
            options={"maxiter": 120, "ftol": 1e-8},
        )
    x = np.asarray(ended.x)
    if not np.all(np.isfinite(x)) or problem.judged(x[: len(problem.names)]) is None:
        return None
    return x


def _squares(n: int) -> Callable[[Array], tuple[float, Array]]:
    """Σ z², and its slope."""
    return lambda x: (float(x[:n] @ x[:n]), 2 * x * (np.arange(len(x)) < n))


def _straight(along: Array) -> Callable[[Array], tuple[float, Array]]:
    """What is furthest along a direction, and its slope."""
    return lambda x: (float(along @ x), along)


def _ranges(problem: PeakProblem, found: Sequence[Array], report: Report) -> Iterator[tuple[str, FactorRange]]:
    """Of each parameter the least and the largest factor, among what was found and by a search from there."""
    n = len(problem.names)
    most = AS_GOOD * float(np.linalg.norm(found[0][:n]))
    near = [x for x in found if np.linalg.norm(x[:n]) <= most]
    room = {
        "type": "ineq",
        "fun": lambda x: np.array([most**2 - x[:n] @ x[:n]]),
        "jac": lambda x: -2 * (x * (np.arange(len(x)) < n))[None],
    }
    for i in range(n):
        report(Progress("other changes", i, n))
        ends = []
        for sign in (1.0, -1.0):
            along = sign * np.eye(len(found[0]))[i]
            tried = [_solved(problem, x, _straight(along), [room]) for x in _apart(near, n)]
            allowed = [x for x in (*tried, *near) if x is not None and np.linalg.norm(x[:n]) <= most * (1 + 1e-6)]
            ends.append(min(allowed, key=along.dot))
        low, high = (_named(problem, x) for x in ends)
        name = problem.names[i]
        yield name, FactorRange(low.factors[name], high.factors[name], low, high)
    report(Progress("other changes", n, n))


def _apart(near: Sequence[Array], n: int) -> list[Array]:
    """Up to three of them that lie apart."""
    kept: list[Array] = []
    for x in near:
        if len(kept) < 3 and all(np.linalg.norm((x - other)[:n]) > 0.05 for other in kept):
            kept.append(x)
    return kept


def _size(problem: PeakProblem, x: Array) -> float:
    """√Σ (ln factor)²."""
    return float(np.linalg.norm(x[: len(problem.names)]))


def _named(problem: PeakProblem, x: Array) -> JointChange:
    z = x[: len(problem.names)]
    found = problem.judged(z) or ()
    factors = {name: float(np.exp(value)) for name, value in zip(problem.names, z, strict=True)}
    return JointChange(factors, float(np.linalg.norm(z)), tuple(of_gain[0] for of_gain in found))


def _words(
    target: PeakTarget,
    already: bool,
    singles: Mapping[str, float | None],
    smallest: JointChange | None,
    others: Mapping[str, FactorRange],
    starts: Starts | None,
) -> Iterator[str]:
    """What was found, in sentences."""
    where = message(
        "peak.inside" if target.axes else "peak",
        frequency=trimmed(target.frequency),
        tolerance=trimmed(target.tolerance),
    )
    if already:
        yield f"The response has {where} as it is."
        return
    alone = {name: factor for name, factor in singles.items() if factor is not None}
    if alone:
        told = ", ".join(f"{name} × {factor:.3g}" for name, factor in alone.items())
        yield f"One parameter alone puts {where}: {told}."
    else:
        yield f"No single one of the parameters {', '.join(singles)} puts {where}, times 0.01 to times 100."
    if smallest is None:
        yield f"No joint change was found that puts {where}; that none exists is not shown."
        return
    told = ", ".join(f"{name} × {factor:.3g}" for name, factor in smallest.factors.items())
    yield f"The smallest joint change found that puts {where}: {told}; √Σ (ln factor)² = {smallest.size:.3g}; {starts}."
    if others:
        spans = ", ".join(f"{name} × {r.lower:.3g} to {r.upper:.3g}" for name, r in others.items())
        yield (
            f"It is one of many: changes up to {AS_GOOD:g} times as large put it there with {spans}. The response does "
            "not say which of them the machine had."
        )

"""The offset of a transducer: what it reads where the model says zero, one number for all of its runs.

A record is y(θ) + b and the residual. Of run j, with its first states taken off, let r̄ be the mean of x_m − y, J̄ that
of ∂y/∂θ, n the number of samples that tell the mean, and P the sum of squares of the residual about its mean. Then

    error_j(b)² = (P + n (r̄ − b)²) / Σ (x_m − mean)²,      F(θ, b) = mean over runs of error_j(b),

and b is at the minimum of F. With one run b is r̄, and F is eq. (17). Where the mean counts (``zeroed: false``), F is
what is fitted: its gradient at the best b is that in θ alone, and its Gauss-Newton matrix has b eliminated, so that
J̄ counts less its mean over the runs, weighted as they are. Elsewhere eq. (17) is fitted, and b is found afterwards.

Where runs begin at rest, their first samples tell b₀ with a standard error σ. That is one more observation, the prior
of b. Of N samples in all the likelihood is a power of F, so with it F is multiplied by exp((b − b₀)²/(2 N σ²)).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ident.fit.criteria import FIT_CRITERIA
from ident.fit.normal_matrices import NormalMatrices
from ident.rounding import EPSILON, TINY
from ident.run import Run, over_runs
from ident.words.error import MEAN_COUNTS

Array = NDArray[np.float64]
_OF = FIT_CRITERIA.offsets


@dataclass(frozen=True)
class Offset:
    """What a transducer reads above the model, in the unit of its channel, and its standard error.

    It is `stated` where the runs say ``zeroed: false``, `large` where it is the larger part of the residual.
    """

    value: float
    std_error: float
    stated: bool = False
    large: bool = False

    @property
    def counts(self) -> bool:
        """Whether it is part of the model: it was stated that there may be one, it is more than chance, or large.

        A large one may be chance where weak parameters move the mean, but no user wants the error that it makes.
        """
        return self.stated or self.large or abs(self.value) > _OF.recognised * self.std_error


class Read(Protocol):
    """An offset, or what a result keeps of one."""

    @property
    def value(self) -> float:
        """In the unit of its channel."""
        ...


class Optimal(Protocol):
    """A fitness at its optimum: see :class:`ident.fit.fitness.Local`."""

    @property
    def runs(self) -> tuple[NormalMatrices, ...]:
        """What each run says."""
        ...

    @property
    def curvature(self) -> Array:
        """The Gauss-Newton matrix, (p, p)."""
        ...

    @property
    def weights(self) -> Array:
        """What each run counts in it."""
        ...


def with_means(runs: Sequence[NormalMatrices]) -> tuple[NormalMatrices, ...]:
    """The runs, those whose mean counts with it, each about the offset of its transducer."""
    found = list(runs)
    for numbers in _by_transducer(runs, [run.counted for run in runs]).values():
        own = [runs[i] for i in numbers]
        prior = _Prior.of(own)
        b = _best(own, prior)
        weights = np.array([_weight(run, b) for run in own])
        centre = (np.array([run.means for run in own]) * weights[:, None]).sum(axis=0) / weights.sum()
        centre *= 1.0 - prior.share(weights.tolist(), own, b)
        centre[-1] = b
        for i in numbers:
            found[i] = prior.on(runs[i].about(runs[i].means - centre), centre)
    return tuple(found)


def offset_of(runs: Sequence[NormalMatrices]) -> float:
    """The offset b of the transducer of these runs, at the minimum of F: the mean of r̄, reweighted until it holds."""
    return _best(runs, _Prior.of(runs))


def _best(runs: Sequence[NormalMatrices], prior: _Prior) -> float:
    means = np.array([run.means[-1] for run in runs])
    b, least = float(np.median(means)), _OF.still * float(np.abs(means).max())
    for _ in range(_OF.rounds if len(runs) > 1 or prior.std_error < np.inf else 0):
        weights = np.array([_weight(run, b) for run in runs])
        told = prior.share(weights.tolist(), runs, b)
        last, b = b, (1.0 - told) * float((means * weights).sum() / weights.sum()) + told * prior.value
        if abs(b - last) <= least:
            break
    return b


def rest_of(known: Iterable[tuple[float, float] | None]) -> tuple[float, float] | None:
    """What runs that begin at rest tell of the offset of their transducer together, and its standard error."""
    told = np.array([one for one in known if one is not None])
    if not len(told):
        return None
    weights = told[:, 1] ** -2.0
    return float(np.average(told[:, 0], weights=weights)), float(weights.sum() ** -0.5)


@dataclass(frozen=True)
class _Prior:
    """What is known of an offset by how its runs begin: b₀, its standard error σ (infinite: nothing), and N σ²."""

    value: float = 0.0
    std_error: float = np.inf
    spread: float = np.inf

    @classmethod
    def of(cls, runs: Sequence[NormalMatrices]) -> _Prior:
        """The prior of the transducer of these runs."""
        known = rest_of(run.rest for run in runs if run.counted)
        return cls() if known is None else cls(*known, sum(run.informing for run in runs) * known[1] ** 2)

    def share(self, weights: Sequence[float], runs: Sequence[NormalMatrices], b: float) -> float:
        """What the prior counts in b, of it and the means of the runs with their weights."""
        own = sum(run.share * float(np.sqrt(_power(run, b) / run.total)) for run in runs) / self.spread
        return own / (own + sum(weights))

    def on(self, run: NormalMatrices, centre: Array) -> NormalMatrices:
        """A run about an offset (the last of the `centre`), with the prior: F times its factor, and its own slope."""
        if not self.spread < np.inf:
            return run
        away = np.append(-centre[:-1], self.value - centre[-1])
        left = float(run.gram[-1, -1] * np.exp(away[-1] ** 2 / self.spread))
        gram = run.gram * (left / run.gram[-1, -1]) + left / self.spread * np.outer(away, away)
        gram[-1, -1] = left
        return replace(run, gram=gram, mean_power=left - run.centred)


def offsets(here: Optimal) -> dict[str, Offset]:
    """The offset of each transducer at an optimum, by its channel, with its standard error.

    To first order b = Σ w n (r̄ − J̄ δθ) / Σ w n, where δθ is the error of the parameters. Both are sums over blocks of
    the records, whose scatter gives the standard error, as that of the parameters (:mod:`ident.fit.uncertainty`).
    """
    if not np.all(np.isfinite(here.curvature)) or not np.all([np.isfinite(run.error) for run in here.runs]):
        return {}
    names = _by_transducer(here.runs, [True] * len(here.runs))
    return {name: _offset(here, frozenset(numbers)) for name, numbers in names.items()}


def offsets_that_count(here: Optimal) -> dict[str, Offset]:
    """Those that are part of the model."""
    return {name: found for name, found in offsets(here).items() if found.counts}


def offset_at(run: Run, offsets: Mapping[str, Read]) -> float:
    """What is part of the model of a run's output, of the offsets of transducers; 0 where its zero is its own."""
    known = offsets.get(run.output)
    return 0.0 if known is None or run.zeroed.get(run.output) else known.value


def _offset(here: Optimal, own: frozenset[int]) -> Offset:
    b = offset_of([here.runs[i] for i in sorted(own)])
    runs = [here.runs[i] for i in sorted(own)]
    counts, prior = np.array([_weight(run, b) if i in own else 0.0 for i, run in enumerate(here.runs)]), _Prior.of(runs)
    told = prior.share(counts[sorted(own)].tolist(), runs, b)
    counts *= (1.0 - told) / counts.sum()
    p = len(here.curvature)
    slope = sum((c * run.means[:p] for c, run in zip(counts, here.runs, strict=True) if c), np.zeros(p))
    through = _solved(here.curvature, slope)
    influence = np.concatenate(
        [
            count / max(run.informing, 1.0) * run.sums_about(b) - weight * run.scores @ through
            for run, weight, count in zip(here.runs, here.weights[: len(here.runs)], counts, strict=True)
        ]
    )
    freedom = len(influence) - p - 1
    scatter = float(influence @ influence) * (len(influence) / freedom if freedom > 0 else 1.0)
    scatter += (told * prior.std_error) ** 2 if told else 0.0
    return Offset(b, float(np.sqrt(scatter)), any(run.counted for run in runs), is_large(runs))


def is_large(runs: Sequence[NormalMatrices]) -> bool:
    """Whether the means are the larger part of the residuals of runs."""
    error, with_mean = over_runs([[run.error, np.hypot(run.error, run.offset)] for run in runs], runs)
    return bool(with_mean > MEAN_COUNTS * error)


def _solved(curvature: Array, slope: Array) -> Array:
    """H⁻¹ s along the directions that the data see."""
    scale = np.sqrt(np.maximum(np.diag(curvature), TINY))
    return np.asarray(
        np.linalg.pinv(curvature / scale / scale[:, None], FIT_CRITERIA.determination.lost, hermitian=True)
        @ (slope / scale)
        / scale
    )


def _weight(run: NormalMatrices, b: float) -> float:
    """w n: what the mean of a run counts, at an offset."""
    return run.share * run.informing / float(np.sqrt(_power(run, b) * run.total))


def _power(run: NormalMatrices, b: float) -> float:
    """Σ of the squares of the residual about an offset."""
    return float(max(run.centred + run.informing * (run.means[-1] - b) ** 2, EPSILON**2 * run.total))


def _by_transducer(runs: Sequence[NormalMatrices], asked: Sequence[bool]) -> Mapping[str, list[int]]:
    """The numbers of the runs that are asked for, by their transducer: those that tell a mean of a shared offset."""
    found: dict[str, list[int]] = {}
    for i, (run, is_asked) in enumerate(zip(runs, asked, strict=True)):
        if is_asked and run.transducer and run.informing > _OF.told * run.length:
            found.setdefault(run.transducer, []).append(i)
    return found

"""What each effect that is off would take off the error, from the responses of the fitted model to it: at once.

The fitted model is simulated with the effect at a few strengths over its range. Each change of the output, and the
sensitivities to the parameters that are on already, are fitted to the residual: that is the error after adding the
effect, to first order in the parameters, and a start for the refit. Strengths that are a share of the range, never
tiny ones: kinks need room, and what approaches zero as a fast time constant would be stiff.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, pairwise

import numpy as np
from numpy.typing import NDArray

from ident.diagnosis.held_out import bounded_step, scored, weight_of_offsets
from ident.diagnosis.models import Models, Refit
from ident.fit.objective import STEP
from ident.fit.output_error import OutputError
from ident.parallel import each

Array = NDArray[np.float64]
SAMPLES = 57_344
_LADDER = (0.01, 0.03, 0.1, 0.3, 1.0)  # of the way from off to each bound
_FINER = (1e-4, 3e-4, 1e-3, 3e-3)  # besides, for a machine of unknown size, whose bounds are wide
_TOGETHER = 6  # effects simulated in one go
_REACH = 2.0  # by which factor a response may be scaled: beyond, it would be another strength's
_FAR = 0.1  # of an axis: a parameter that hardly matters where it is may be sent anywhere by a linearisation
_PARTS = (1.0, 0.5, 0.2, 0.05, 0.01)  # of the way to a prediction: it may be too bold
_SUDDEN, _WIDE = 300.0, 4.0  # a response grows so much in power, over so wide a step, by a threshold between
_BETWEEN = (0.2, 0.4, 0.6, 0.8)  # powers of the step
_BACK = (0.67, 0.33, 0.0)  # powers of the share of the simulated strength
_ROUNDS = 3  # of weighting each run by what it is left with


@dataclass(frozen=True)
class Outlook:
    """Eq. (17) averaged over the runs, the root mean square of their offsets, and the score of both together."""

    error: float
    offset: float
    score: float


@dataclass(frozen=True)
class Prediction:
    """An effect's predicted error and offset, the same without it, and the values from which to refit with it.

    All on the beginnings of the records; `runs` is their number. `starts` are the fitted model with the effect on, from
    the strength that was simulated to the share of it that fits best: what has a threshold needs the former, for a
    share of its response is not the response to a share; what is proportional the latter.
    """

    effect: str
    after: Outlook
    before: Outlook
    runs: int
    starts: tuple[Mapping[str, float], ...]

    @property
    def fall(self) -> float:
        """Relative fall of the error."""
        return 1.0 - self.after.error / self.before.error

    @property
    def nats(self) -> float:
        """By how much the runs' offsets become more likely."""
        return self.runs * float(np.log(self.before.offset / self.after.offset))


def predict(models: Models, base: Refit, names: Sequence[str]) -> list[Prediction]:
    """What adding each effect to the refitted model promises, in the order of the names."""
    whole = models.fitness((*base.effects, *names), SAMPLES, whole=True) if models.fit_together else None
    together = 1 if whole is None else _TOGETHER
    shares = [list(names[i : i + together]) for i in range(0, len(names), together)]

    def of_share(share: list[str]) -> list[Prediction]:
        return _predicted(models, whole or models.fitness((*base.effects, *share), SAMPLES), base, share)

    return list(chain.from_iterable(each(of_share, shares)))


def _predicted(models: Models, fitness: OutputError, base: Refit, names: list[str]) -> list[Prediction]:
    """The predictions of a few effects, simulated in one go, and again where a threshold was jumped over."""
    off = {symbol: value for symbol, value in models.off.items() if symbol not in base.values}
    known = {name: value for name, value in {**off, **base.values}.items() if name in fitness.space.order}
    trials = [(name, strength) for name in names for strength in _strengths(fitness, models.strength(name), known)]
    found = _Simulated.of(models, fitness, base, known, trials)
    between = found.thresholds()
    every = [found, _Simulated.of(models, fitness, base, known, between)] if between else [found]
    best = {name: (found.before, np.zeros(len(base.point) + 1), strength) for name, strength in reversed(trials)}
    for name, after, step, strength in chain.from_iterable(simulated.outlooks() for simulated in every):
        if after.score < best[name][0].score:
            best[name] = after, step, strength
    return [
        Prediction(name, after, found.before, len(found.gram), _starts(models, base, name, step, strength))
        for name, (after, step, strength) in ((name, best[name]) for name in names)
    ]


@dataclass(frozen=True)
class _Simulated:
    """The products of a fitted model's sensitivities, of its responses to effects of some strengths, and its residual.

    `gram` (runs, q, q) and `means` (runs, q): the p parameters, one column each trial, the residual.
    """

    point: Array
    trials: list[tuple[str, float]]
    gram: Array
    means: Array
    records: _Records

    @classmethod
    def of(
        cls, models: Models, fitness: OutputError, base: Refit, known: Mapping[str, float],
        trials: list[tuple[str, float]],
    ) -> _Simulated:  # fmt: skip
        """Simulate the model with each strength alone."""
        values, strides = _cloud(base, known, [(models.strength(name), strength) for name, strength in trials])
        gram, means = fitness.differences(values, strides)
        totals = np.array([np.sum((r.measured - r.measured.mean()) ** 2) for r in fitness.runs])
        return cls(base.point, trials, gram, means, _Records(totals, np.array([r.length for r in fitness.runs])))

    @cached_property
    def before(self) -> Outlook:
        """Without any effect."""
        return self._after(list(range(len(self.point))))[0]

    def outlooks(self) -> Iterator[tuple[str, Outlook, Array, float]]:
        """Effect, what is left with a share of its response, the step to there, the strength that was simulated."""
        p = len(self.point)
        for i, (name, strength) in enumerate(self.trials):
            if self._power(i) > 0:
                yield name, *self._after([*range(p), p + i]), strength

    def thresholds(self) -> list[tuple[str, float]]:
        """Strengths between two neighbours of which one does next to nothing and the other much."""
        found: list[tuple[str, float]] = []
        for i, ((name, a), (other, b)) in enumerate(pairwise(self.trials)):
            if name == other and 1 < b / a < _WIDE and self._power(i + 1) > _SUDDEN * self._power(i):
                found += [(name, a * (b / a) ** share) for share in _BETWEEN]
        return found

    def _power(self, trial: int) -> float:
        column = len(self.point) + trial
        return float(self.gram[:, column, column].sum())

    def _after(self, columns: list[int]) -> tuple[Outlook, Array]:
        kept = np.array([*columns, self.gram.shape[-1] - 1])
        return _after(self.gram[:, kept[:, None], kept], self.means[:, kept], self.records, self.point, len(self.point))


def _starts(models: Models, base: Refit, name: str, step: Array, strength: float) -> tuple[dict[str, float], ...]:
    """The values from which to refit with the effect: parts of the way to the prediction, and of the way back."""
    p, symbol = len(base.point), models.strength(name)
    moved = np.clip(step[:p], -_FAR, _FAR)

    def at(share: float, here: float) -> dict[str, float]:
        point = np.clip(base.point + share * moved, 0.0, 1.0)
        values = {key: float(value[0]) for key, value in base.space.values(point[None]).items()}
        return {**base.values, **values, symbol: here}

    scaled = float(step[p])
    parts = [at(share, share * scaled * strength) for share in _PARTS]
    return (*parts, *(at(1.0, scaled**share * strength) for share in _BACK)) if scaled else tuple(parts)


def _strengths(fitness: OutputError, symbol: str, values: Mapping[str, float]) -> list[float]:
    """The strengths to try, SI: shares of the way from off to each bound."""
    lower, upper = fitness.space.bounds(values)[symbol]
    ends = [end for end in (upper, lower) if end]
    shares = (*_FINER, *_LADDER) if fitness.space.scale_free else _LADDER
    return [share * end for end in ends for share in shares]


def _cloud(
    base: Refit, values: Mapping[str, float], trials: Sequence[tuple[str, float]]
) -> tuple[dict[str, Array], Array]:  # fmt: skip
    """The fitted model, it with each parameter moved, and it with each strength; the strides of these."""
    p = len(base.point)
    signs = np.where(base.point + STEP > 1.0, -1.0, 1.0)
    points = np.concatenate([base.point[None], base.point + np.diag(STEP * signs)])
    moved = base.space.values(np.concatenate([points, np.repeat(base.point[None], len(trials), axis=0)]))
    cloud = {name: np.full(p + 1 + len(trials), value) for name, value in values.items()}
    cloud |= {name: value for name, value in moved.items() if name in cloud}
    for i, (symbol, strength) in enumerate(trials):
        cloud[symbol] = cloud[symbol].copy()
        cloud[symbol][p + 1 + i] = strength
    return cloud, np.concatenate([STEP * signs, np.ones(len(trials))])


@dataclass(frozen=True)
class _Records:
    """The power Σ (x_m − mean)² of each record and its length, (runs,)."""

    totals: Array
    lengths: Array


def _after(
    gram: Array, means: Array, records: _Records, point: Array, fitted: int
) -> tuple[Outlook, Array]:  # fmt: skip
    """What is left after the best step of the `fitted` parameters and, where there is one, the strength's share."""
    p, runs = gram.shape[-1] - 1, len(gram)
    here = np.append(point, np.zeros(p - fitted))  # the strength's axis runs from 0 to _REACH
    scale = np.append(np.ones(fitted), np.full(p - fitted, _REACH))
    share = weight_of_offsets(runs, int(records.lengths.sum()))
    offsets = (means - means.mean(axis=0)) / np.sqrt(records.totals / records.lengths)[:, None]
    of_offsets = offsets.T @ offsets
    left = gram[:, p, p]
    step, direction = np.zeros(p), np.append(np.zeros(p), 1.0)
    for _ in range(_ROUNDS):
        weights = 1.0 / np.sqrt(np.maximum(left, 1e-24 * records.totals) * records.totals)
        joint = np.einsum("r,rij->ij", weights, gram)
        error = float(np.mean(np.sqrt(left / records.totals)))
        squared = max(float(direction @ of_offsets @ direction), 1e-18 * runs)
        joint += share * runs * error * of_offsets / squared  # the gradient of the score's second part
        H, g = joint[:p, :p], -joint[:p, p]
        step = scale * bounded_step(here / scale, H * scale[:, None] * scale, g * scale)
        direction = np.append(-step, 1.0)
        left = np.maximum(np.einsum("i,rij,j->r", direction, gram, direction), 1e-12 * records.totals)
    error = float(np.mean(np.sqrt(left / records.totals)))
    offset = float(np.sqrt(max(direction @ of_offsets @ direction, 1e-18 * runs) / runs))
    return Outlook(error, offset, scored(error, offset, share)), step

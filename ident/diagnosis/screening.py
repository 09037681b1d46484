"""What each effect that is off would take off the error, from the responses of the fitted model to it: at once.

The fitted model is simulated with the effect at a few strengths over its range. Each change of the output, and the
sensitivities to the parameters that are on already, are fitted to the residual: that is the error after adding the
effect, to first order in the parameters, and a start for the refit. Strengths that are a share of the range, never
tiny ones: kinks need room, and what approaches zero as a fast time constant would be stiff.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain, pairwise

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.cross_validation import scored, weight_of_offsets
from ident.diagnosis.evidence.chance import bar
from ident.diagnosis.evidence.comparison import Residuals, common_disturbance
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.initial_guesses import in_place_of_spring, initial_guesses, strength_in_model, strength_in_records
from ident.fit.bounded_step import bounded_steps
from ident.fit.criteria import FIT_CRITERIA
from ident.fit.responses import Responses, Sensitivities
from ident.fit.simulated_fitness import SimulatedFitness
from ident.fit.space import Space
from ident.parallel import each
from ident.rounding import EPSILON

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PredictedFit:
    """Eq. (17) averaged over the runs, the root mean square of their offsets, and the score of both together."""

    error: float
    offset: float
    score: float


@dataclass(frozen=True)
class Prediction:
    """An effect's predicted error and offset, the same without it, and the values from which to refit with it.

    All on the beginnings of the records; `runs` is their number. `starts` are the fitted model with the effect on, from
    the strength that was simulated to the share of it that fits best: what has a threshold needs the former, for a
    share of its response is not the response to a share; what is proportional the latter. Where the records show the
    strength by themselves, that too. `elsewhere` are the same from the other places of its shapes, the best first.
    `simulated` are those strengths that promise most as they were simulated: a share of a threshold may be none.
    """

    effect: str
    after: PredictedFit
    before: PredictedFit
    runs: int
    starts: tuple[Mapping[str, float], ...]
    elsewhere: tuple[tuple[Mapping[str, float], ...], ...] = ()
    simulated: tuple[Mapping[str, float], ...] = ()

    @property
    def remaining(self) -> float:
        """The error after the step over the error before it."""
        return self.after.error / self.before.error

    @property
    def reduction(self) -> float:
        """Relative fall of the error."""
        return 1.0 - self.remaining

    @property
    def offset_likelihood_gain(self) -> float:
        """By how much the runs' offsets become more likely."""
        return self.runs * float(np.log(self.before.offset / self.after.offset))


def predict(models: CandidateModels, base: FittedModel, names: Sequence[str]) -> list[Prediction]:
    """What adding each effect to the refitted model promises, in the order of the names."""
    given = _Sensitivities.of(models, base)
    found = each(lambda group: _predicted(given, base, group), models.groups(base.effects, names))
    return sorted(chain.from_iterable(found), key=lambda prediction: names.index(prediction.effect))


def gain_by_chance(models: CandidateModels, base: FittedModel, names: Sequence[str]) -> float:
    """The gain (nats) that the best of these effects makes by chance, but for one in twenty: the bar of a gain.

    On the shortened records, of the response to each effect half way along its range by the logarithm.
    """
    given = _Sensitivities.of(models, base)
    found = each(lambda group: _response_of_each(given, base, group), models.groups(base.effects, names))
    runs, p = given.sensitivities.fitness.runs, len(base.point)
    of_runs = [
        _without_first_state(
            given.sensitivities.columns[run.id].Z, np.column_stack([part[run.id] for part in found]), p
        )
        for run in runs
    ]
    residuals, free, candidates = zip(*of_runs, strict=True)
    bands = models.compared_records(CRITERIA.estimation.rough_samples).bands
    return bar(residuals, free, candidates, common_disturbance([Residuals(tuple(residuals), bands)]))


def _without_first_state(Z: Array, responses: Array, p: int) -> tuple[Array, Array, Array]:
    """Residual (n,), sensitivities (n, p+1) and responses (n, k) of a run, less what its own first state explains.

    Z = [J, N, 1, r] holds the p sensitivities J, and N to the first state, none where that is known.
    """
    signals = np.column_stack([Z[-1], Z[:p].T, Z[-2], responses])
    if len(Z) > p + 2:
        first_state, _ = np.linalg.qr(Z[p:-2].T)
        signals = signals - first_state @ (first_state.T @ signals)
    return signals[:, 0], signals[:, 1 : p + 2], signals[:, p + 2 :]


def _response_of_each(given: _Sensitivities, base: FittedModel, names: Sequence[str]) -> dict[str, Array]:
    """The response (n, effects) of each run, by its id, to each of some effects that one chain holds."""
    models, fitness = given.models, given.models.fitness((*base.effects, *names), CRITERIA.estimation.rough_samples)
    values = _values_without(models, base, fitness)
    trials = [list(_trials(models, base, fitness.space, name, values)) for name in names]
    middle = [each_of[len(each_of) // 2] for each_of in trials]
    return given.sensitivities.series_beside(fitness, values, given.values_of(values, middle))


def _values_without(models: CandidateModels, base: FittedModel, fitness: SimulatedFitness) -> dict[str, float]:
    """The values of everything in a space, the effects that are not the model's own off, also what is held of them.

    A searched parameter of an effect has its usual value, or the middle of its range where the range, which is that of
    the records, does not hold that: in records of hours, a force that relaxes within a tenth of a second would run
    away, though it acts by nothing.
    """
    off = {symbol: value for symbol, value in models.off.items() if symbol not in base.values}
    held = {name: value for name, value in fitness.space.fixed.items() if name not in base.values}
    bounds = fitness.space.bounds({**off, **base.values, **held})
    middle = fitness.space.values(np.full((1, len(fitness.space.axes)), 0.5))
    beyond = [
        name for name in fitness.space.names if name in off and not bounds[name][0] <= off[name] <= bounds[name][1]
    ]
    searched = {name: float(middle[name][0]) for name in beyond}
    strengths = {symbol: 0.0 for symbol in map(models.strength, models.effects) if symbol in off}
    values = {**off, **base.values, **held, **searched, **strengths}
    return {name: value for name, value in values.items() if name in fitness.space.order}


def _predicted(given: _Sensitivities, base: FittedModel, names: Sequence[str]) -> list[Prediction]:
    """The predictions of effects that one chain holds.

    Strengths are added where a threshold was jumped over, and beyond a range whose end is not enough.
    """
    models, fitness = given.models, given.models.fitness((*base.effects, *names), CRITERIA.estimation.rough_samples)
    values = _values_without(models, base, fitness)
    trials = [trial for name in names for trial in _trials(models, base, fitness.space, name, values)]
    found = given.with_effects(fitness, values, trials)
    before = given.before
    promises = list(found.predicted_fits())
    if between := found.thresholds():
        promises += given.with_effects(fitness, values, between).predicted_fits()
    for _ in range(FIT_CRITERIA.ranges.rounds):
        if not (beyond := _beyond(models, fitness, values, promises)):
            break
        promises += given.with_effects(fitness, values, beyond).predicted_fits()
    nothing = {trial.effect: (trial, before, np.zeros(len(base.point) + 1)) for trial in reversed(trials)}
    best: dict[str, dict[tuple[float, ...], _Promise]] = {name: {} for name in names}
    for promise in promises:
        trial, after, _ = promise
        of_shape, shape = best[trial.effect], tuple(trial.shape.values())
        least = of_shape.get(shape, nothing[trial.effect])[1].score
        if after.score < (1.0 - CRITERIA.equality.tie) * least:
            of_shape[shape] = promise
    few = slice(CRITERIA.screening.elsewhere)

    def prediction(name: str) -> Prediction:
        first, *others = sorted(best[name].values(), key=_score) or [nothing[name]]
        recorded = _from_records(models, base, fitness.space, name, values)
        of_effect = sorted((promise for promise in promises if promise[0].effect == name), key=_score)
        return Prediction(
            name,
            first[1],
            before,
            len(given.gram),
            (*_refit_starts(models, base, first), *recorded),
            (
                *((start,) for start in in_place_of_spring(base, models.effects[name])),
                *(_refit_starts(models, base, other) for other in others[few]),
            ),
            tuple(_as_simulated(models, base, trial) for trial, _, _ in of_effect[few]),
        )

    return [prediction(name) for name in names]


def _beyond(
    models: CandidateModels, fitness: SimulatedFitness, values: Mapping[str, float], promises: Iterable[_Promise]
) -> list[_Trial]:
    """Strengths beyond the end of a range, of effects that promise most there, and more the stronger they are.

    The range of a machine of unknown size is an order of magnitude.
    """
    best: dict[str, _Promise] = {}
    for promise in promises:
        effect = promise[0].effect
        best[effect] = min(best.get(effect, promise), promise, key=_score)
    most = (1.0 - EPSILON) * CRITERIA.screening.max_scaling
    found = []
    for trial, _, step in best.values():
        lower, upper = fitness.space.reach(models.strength(trial.effect), values)
        at_end = trial.strength >= (1.0 - EPSILON) * upper or trial.strength <= (1.0 - EPSILON) * lower < 0
        if at_end and step[-1] >= most and models.may_reach_farther(fitness, trial.effect):
            found.append(replace(trial, strength=FIT_CRITERIA.ranges.further * trial.strength))
    return found


def _as_simulated(models: CandidateModels, base: FittedModel, trial: _Trial) -> dict[str, float]:
    """The fitted model with the effect as it was simulated."""
    return {**base.values, **trial.shape, models.strength(trial.effect): trial.strength}


def _score(promise: _Promise) -> float:
    return promise[1].score


@dataclass(frozen=True)
class _Trial:
    """An effect at a strength, and at values of the shapes that are searched with it, by the equations' names."""

    effect: str
    strength: float
    shape: Mapping[str, float]


_Promise = tuple[_Trial, PredictedFit, Array]
"""A trial, the fit that it predicts, and the step to there."""


@dataclass(frozen=True)
class _Sensitivities:
    """A fitted model's sensitivities and residual at each run, beside which effects are set.

    `gram` (runs, p+1, p+1) and `means` (runs, p+1) are of the p parameters and the residual.
    """

    models: CandidateModels
    point: Array
    sensitivities: Sensitivities
    gram: Array
    means: Array
    records: _Records

    @classmethod
    def of(cls, models: CandidateModels, base: FittedModel) -> _Sensitivities:
        """Simulate the model with each parameter moved."""
        fitness = models.fitness(base.effects, CRITERIA.estimation.rough_samples)
        found = Sensitivities.of(fitness, base.point)
        totals = np.array([np.sum((r.measured - r.measured.mean()) ** 2) for r in fitness.runs])
        records = _Records(totals, np.array([r.length for r in fitness.runs]))
        return cls(models, base.point, found, *found.products(), records)

    def with_effects(
        self, fitness: SimulatedFitness, known: Mapping[str, float], trials: list[_Trial]
    ) -> _EffectResponses:
        """The model with each effect at its strength alone; `known` are its values without, by the equations' names."""
        return _EffectResponses(self, trials, self.sensitivities.beside(fitness, known, self.values_of(known, trials)))

    def values_of(self, known: Mapping[str, float], trials: Sequence[_Trial]) -> dict[str, Array]:
        """The values of everything at each trial, (trials,), by the equations' names."""
        values = {name: np.full(len(trials), value) for name, value in known.items()}
        for i, trial in enumerate(trials):
            values[self.models.strength(trial.effect)][i] = trial.strength
            for name, value in trial.shape.items():
                values[name][i] = value
        return values

    @cached_property
    def before(self) -> PredictedFit:
        """Without any effect."""
        ((fit_without, _),) = _after(self.gram[None], self.means[None], self.records, self.point, len(self.point))
        return fit_without


@dataclass(frozen=True)
class _EffectResponses:
    """The responses of a fitted model to effects of some strengths."""

    sensitivities: _Sensitivities
    trials: list[_Trial]
    responses: Responses

    def predicted_fits(self) -> Iterator[_Promise]:
        """The trials that were simulated, the fit predicted with a share of the response of each, and the step to
        there."""
        shown = [i for i in range(len(self.trials)) if self._power(i) > 0]
        after = self._after(shown) if shown else ()
        yield from ((self.trials[i], *found) for i, found in zip(shown, after, strict=True))

    def thresholds(self) -> list[_Trial]:
        """Strengths between two neighbours of which one does next to nothing and the other much."""
        found: list[_Trial] = []
        for i, (one, other) in enumerate(pairwise(self.trials)):
            if one != replace(other, strength=one.strength):
                continue
            ratio = other.strength / one.strength
            if ratio > 1 and self._power(i + 1) > CRITERIA.screening.threshold_growth * self._power(i):
                places = CRITERIA.initial_guesses.along_range
                found += [replace(one, strength=one.strength * ratio**place) for place in places]
        return found

    def _power(self, trial: int) -> float:
        return float(self.responses.power[:, trial].sum())

    def _after(self, trials: Sequence[int]) -> Iterator[tuple[PredictedFit, Array]]:
        p, given, responses = len(self.sensitivities.point), self.sensitivities, self.responses
        old = [*range(p), p + 1]  # the effect's share stands behind the parameters, the residual last
        gram = np.empty((len(trials), len(given.gram), p + 2, p + 2))
        gram[:, :, *np.ix_(old, old)] = given.gram
        gram[:, :, old, p] = gram[:, :, p, old] = responses.products[:, :, trials].transpose(2, 0, 1)
        gram[:, :, p, p] = responses.power[:, trials].T
        means = np.empty(gram.shape[:3])
        means[..., old], means[..., p] = given.means, responses.means[:, trials].T
        return _after(gram, means, given.records, given.point, p)


def _refit_starts(models: CandidateModels, base: FittedModel, promise: _Promise) -> tuple[dict[str, float], ...]:
    """The values from which to refit with the effect: parts of the way to the prediction, and of the way back."""
    trial, _, step = promise
    p, symbol = len(base.point), models.strength(trial.effect)
    longest = CRITERIA.cross_validation.longest_step
    moved = np.clip(step[:p], -longest, longest)

    def at(share: float, here: float) -> dict[str, float]:
        point = np.clip(base.point + share * moved, 0.0, 1.0)
        values = {key: float(value[0]) for key, value in base.space.values(point[None]).items()}
        return {**base.values, **values, **trial.shape, symbol: here}

    scaled = float(step[p])
    parts = [at(share, share * scaled * trial.strength) for share in CRITERIA.cross_validation.step_shares]
    return (
        (*parts, *(at(1.0, scaled**share * trial.strength) for share in CRITERIA.screening.strength_powers))
        if scaled
        else tuple(parts)
    )


def _from_records(
    models: CandidateModels, base: FittedModel, space: Space, name: str, known: Mapping[str, float]
) -> Iterator[dict[str, float]]:
    """The fitted model with an effect as strong as the records show by themselves, where they do, and as the model
    has it."""
    effect = models.effects[name]
    for strength in (strength_in_records(base, effect), strength_in_model(base, effect)):
        if strength is not None:
            for shape in initial_guesses(base, effect, space, known):
                yield {**base.values, **shape, models.strength(name): strength}


def _trials(
    models: CandidateModels, base: FittedModel, space: Space, name: str, known: Mapping[str, float]
) -> Iterator[_Trial]:
    """The strengths to try, SI: shares of the way from off to each bound, from wherever the shapes may begin; and of an
    effect that is a spring at small motions, those in the place of a part of the machine's spring."""
    lower, upper = space.reach(models.strength(name), known)
    covered = strength_in_records(base, models.effects[name])
    shapes = initial_guesses(base, models.effects[name], space, known)
    shares = (
        CRITERIA.screening.strengths_of_many
        if len(shapes) > CRITERIA.screening.many_shapes
        else (*CRITERIA.screening.weak_strengths, *CRITERIA.screening.strengths)
        if space.scale_free
        else CRITERIA.screening.strengths
    )
    if covered is not None:
        shares, upper, lower = CRITERIA.screening.strengths_of_stop, min(covered, upper), 0.0
    if models.strength(name) in space.fixed:
        shares, lower = (1.0,), 0.0
    for shape in shapes:
        for end in (upper, lower):
            yield from (_Trial(name, share * end, shape) for share in shares if end)
    for start in in_place_of_spring(base, models.effects[name]):
        others = {other: value for other, value in start.items() if other in known and value != known[other]}
        yield _Trial(name, others.pop(models.strength(name)), others)


@dataclass(frozen=True)
class _Records:
    """The power Σ (x_m − mean)² of each record and its length, (runs,)."""

    totals: Array
    lengths: Array


def _after(
    gram: Array, means: Array, records: _Records, point: Array, fitted: int
) -> Iterator[tuple[PredictedFit, Array]]:
    """The fit predicted after the best step of the `fitted` parameters and, where there is one, of the strength's
    share.

    Of n problems side by side: `gram` (n, runs, p+1, p+1), `means` (n, runs, p+1); the residual is last.
    """
    count, runs, p = *gram.shape[:2], gram.shape[-1] - 1
    here = np.append(point, np.zeros(p - fitted))  # the strength's axis runs from 0 to _REACH
    scale = np.append(np.ones(fitted), np.full(p - fitted, CRITERIA.screening.max_scaling))
    share = weight_of_offsets(runs, int(records.lengths.sum()))
    offsets = (means - means.mean(axis=1, keepdims=True)) / np.sqrt(records.totals / records.lengths)[:, None]
    of_offsets = offsets.transpose(0, 2, 1) @ offsets
    least_offset = CRITERIA.evidence.level
    flat, left = gram.reshape(count, runs, -1), gram[..., p, p]
    step, direction = np.zeros((count, p)), np.append(np.zeros((count, p)), np.ones((count, 1)), axis=1)
    for _ in range(CRITERIA.screening.reweighting_rounds):
        weights = 1.0 / np.sqrt(np.maximum(left, EPSILON**2 * records.totals) * records.totals)
        joint = (weights[:, None] @ flat).reshape(count, p + 1, p + 1)
        error = np.mean(np.sqrt(left / records.totals), axis=1)
        squared = np.maximum(_along(of_offsets[:, None], direction)[:, 0], least_offset**2 * runs)
        joint += (share * runs * error / squared)[:, None, None] * of_offsets  # the gradient of the second part
        H, g = joint[:, :p, :p], -joint[:, :p, p]
        step = scale * bounded_steps(here / scale, H * scale[:, None] * scale, g * scale)
        direction = np.append(-step, np.ones((count, 1)), axis=1)
        left = np.maximum(_along(gram, direction), EPSILON * records.totals)
    error = np.mean(np.sqrt(left / records.totals), axis=1)
    offset = np.sqrt(np.maximum(_along(of_offsets[:, None], direction)[:, 0], least_offset**2 * runs) / runs)
    for one, other, found in zip(error.tolist(), offset.tolist(), step, strict=True):
        yield PredictedFit(one, other, scored(one, other, share)), found


def _along(products: Array, direction: Array) -> Array:
    """dᵀ P d of each of n problems, (n, runs): `products` (n, runs, q, q), `direction` (n, q)."""
    return np.asarray((products @ direction[:, None, :, None])[..., 0] @ direction[:, :, None])[..., 0]

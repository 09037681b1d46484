"""The effects that are off, ranked: predicted at once, contenders refitted, finalists judged on held-out data."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import chain
from typing import TypeVar

import numpy as np

from ident.diagnosis.candidate import Candidate, in_rank_order
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.free_shapes import trial_from_everywhere
from ident.diagnosis.model_comparison import finite_everywhere
from ident.diagnosis.screening import Prediction, predict
from ident.diagnosis.tie_breaking import stable_minimum, stable_ranking
from ident.fit.wider_bounds import within_ranges
from ident.parallel import each
from ident.progress import Expected, Progress, Report, counted

Item = TypeVar("Item")
_AGAIN = "starting again"  # from other strengths: the stage of a report

Base = tuple[FittedModel, Sequence[str]]
"""A model, and the effects that could be added to it."""


Listener = Callable[[list[Candidate]], None]
"""Told of the candidates of one model as far as each has come, while the ranking goes on."""


def _no_listener(_candidates: list[Candidate]) -> None:
    """Keep nothing."""


def rank(
    models: CandidateModels,
    base: FittedModel,
    names: Sequence[str],
    report: Report,
    thorough: bool = True,
    strong: bool = False,
    listener: Listener = _no_listener,
) -> list[Candidate]:
    """The candidates, best first.

    `thorough`: more are refitted, and also where no prediction is worth it. `strong`: from strong effects, too. A
    prediction from the fitted parameters does not see these where the parameters, without the effect, went far astray.
    """
    return rank_each(models, [(base, names)], report, thorough, strong, listener=listener)[0]


def rank_each(
    models: CandidateModels,
    bases: Sequence[Base],
    report: Report,
    thorough: bool = True,
    strong: bool = False,
    incumbent: FittedModel | None = None,
    listener: Listener = _no_listener,
) -> list[list[Candidate]]:
    """The same for several models, with what is refitted for all of them side by side.

    With an `incumbent`, a model that each base is a part of, only candidates about as good as that count, and others
    are given up on the way. It is among the candidates as it is, or as a refit from a base finds it, if that is better.
    """
    predicted = [_predictions(models, base, names, report) for base, names in bases]
    listener(_so_far(predicted[0]))
    models_of = [base for base, _ in bases]
    near = (_near(models, *of) for of in zip(models_of, predicted, strict=True))
    on_trial = [_contenders(models, of) for of in predicted] if thorough else list(near)
    finalists_at_least = CRITERIA.ranking.finalists if thorough else 2
    targets = {base.effects: _target(models, base, incumbent) for base in models_of}
    below_incumbent = (
        CRITERIA.estimation.new_optimum * models.trial_error(incumbent) if incumbent is not None else np.inf
    )

    def trial(base: FittedModel, prediction: Prediction) -> Candidate:
        aim = below_incumbent if _is_incumbent(base, prediction, incumbent) else targets[base.effects]
        return _tried(models, base, prediction, aim, strong)

    trials = _in_turn(models, models_of, predicted, on_trial, _counted("trying", on_trial, trial, report))
    tried = [
        in_rank_order(models, _that_count(base, ones, incumbent, below_incumbent))
        for base, ones in zip(models_of, trials, strict=True)
    ]
    listener(_so_far(predicted[0], tried[0]))
    finalists = [_finalists(models, *of, finalists_at_least) for of in zip(models_of, tried, strict=True)]
    best = {
        base.effects: min((one.score for one in ones), default=np.inf)
        for base, ones in zip(models_of, tried, strict=True)
    }

    def final(base: FittedModel, candidate: Candidate) -> Candidate:
        return _confirmed(models, base, candidate, best[base.effects])

    confirm = _counted("confirming", finalists, final, report)
    found = [in_rank_order(models, ones) for ones in _side_by_side(confirm, models_of, finalists)]
    listener(_so_far(predicted[0], tried[0], found[0]))
    deeper = [ones[: CRITERIA.ranking.multistart_finalists if thorough else 1] for ones in found]
    multistart = partial(_multistart, models, targets if incumbent else {})
    restarted = _side_by_side(_counted(_AGAIN, deeper, multistart, report), models_of, deeper)
    return [
        _joined(models, base, of, stages, incumbent)
        for base, of, *stages in zip(models_of, predicted, tried, found, restarted, strict=True)
    ]


def _counted(
    stage: str, items: Sequence[Sequence[Item]], function: Callable[[FittedModel, Item], Candidate], report: Report
) -> Callable[[FittedModel, Item], Candidate]:
    """The function, which reports each item that it is through with, of those there are by then."""

    def total() -> int:
        return sum(map(len, items))

    if any(items):
        report(Progress(stage, 0, total()))
    return counted(function, stage, total, report)


def _that_count(
    base: FittedModel, trials: Sequence[Candidate], incumbent: FittedModel | None, error: float
) -> list[Candidate]:
    """The trials; that of the incumbent itself only where it is below an error, at a better optimum."""
    return [one for one in trials if not _is_incumbent(base, one.prediction, incumbent) or _comes_below(one, error)]


def _so_far(predicted: Sequence[Prediction], *stages: Sequence[Candidate]) -> list[Candidate]:
    """The candidates by how far they came, those that came as far by their score."""
    came = {one.effect: one for one in chain(*stages)}
    listed = [came.get(one.effect, Candidate(one)) for one in predicted]
    return sorted(listed, key=lambda one: (one.stage, one.score))


def _in_turn(
    models: CandidateModels,
    bases: Sequence[FittedModel],
    predicted: Sequence[Sequence[Prediction]],
    on_trial: list[list[Prediction]],
    trial: Callable[[FittedModel, Prediction], Candidate],
) -> list[list[Candidate]]:
    """A trial of each base's contenders, to which what they pass over is added, and then of that."""
    first = _side_by_side(trial, bases, on_trial)
    overlooked = [_overlooked(models, *of) for of in zip(bases, predicted, first, strict=True)]
    on_trial += overlooked
    second = _side_by_side(trial, bases, overlooked)
    return [[*ones, *more] for ones, more in zip(first, second, strict=True)]


def _joined(
    models: CandidateModels,
    base: FittedModel,
    predicted: Sequence[Prediction],
    stages: Sequence[Sequence[Candidate]],
    incumbent: FittedModel | None,
) -> list[Candidate]:
    """The candidates as far as each came; the model `beside` the base as it is, unless it was found anew and better."""
    came = {one.effect: one for one in chain(*stages)}
    came |= {
        one.effect: one
        for one in _incumbent_as_candidate(models, base, predicted, incumbent)
        if not _is_better(came.get(one.effect), one)
    }
    return in_rank_order(models, [came.get(one.effect, Candidate(one)) for one in predicted])


def deepened(
    models: CandidateModels, base: FittedModel, ranking: Sequence[Candidate], report: Report
) -> list[Candidate]:
    """The ranking of a small matrix, once all its finalists are looked for elsewhere; as it is of a large one."""
    if not models.is_quick(base):
        return list(ranking)
    finalists, rest = ranking[: CRITERIA.ranking.finalists], ranking[CRITERIA.ranking.finalists :]
    further = [finalists[CRITERIA.ranking.multistart_finalists :]]
    (restarted,) = _side_by_side(_counted(_AGAIN, further, partial(_multistart, models, {}), report), [base], further)
    return in_rank_order(models, [*finalists[: CRITERIA.ranking.multistart_finalists], *restarted, *rest])


def _tried(models: CandidateModels, base: FittedModel, prediction: Prediction, aim: float, strong: bool) -> Candidate:
    """A candidate after its first refit, which has to come below `aim`; from strong effects, too, where asked."""
    if models.is_short(base):
        refit = trial_from_everywhere(models, base, prediction, aim)
    else:
        refit = models.trial((*base.effects, prediction.effect), prediction.starts, aim)
    if strong:
        other = models.multistart(refit, _strong_starts(models, base, refit), min(aim, refit.local.error))
        refit = stable_minimum([refit, other], lambda r: r.local.error)
    return Candidate(prediction, refit if refit.finite else None)


def _confirmed(models: CandidateModels, base: FittedModel, candidate: Candidate, best: float) -> Candidate:
    """A candidate refitted to every sample, as closely as its score on trial asks for; `best` is the least of all."""
    assert candidate.trial is not None
    is_behind = candidate.score > CRITERIA.ranking.close_trial * best
    way = CRITERIA.estimation.coarse if is_behind else CRITERIA.estimation.full
    refit = models.refit((*base.effects, candidate.effect), candidate.trial.values, way=way)
    if not finite_everywhere(refit):
        return replace(candidate, trial=None)
    return candidate.refitted(models, base, refit)


def _side_by_side(
    function: Callable[[FittedModel, Item], Candidate], bases: Sequence[FittedModel], items: Sequence[Sequence[Item]]
) -> list[list[Candidate]]:
    """`function` of each base and each of its items, all of them at once."""
    todo = [(number, base, item) for number, base in enumerate(bases) for item in items[number]]
    done = each(lambda one: function(one[1], one[2]), todo)
    return [[made for (of, _, _), made in zip(todo, done, strict=True) if of == number] for number in range(len(bases))]


def _predictions(models: CandidateModels, base: FittedModel, names: Sequence[str], report: Report) -> list[Prediction]:
    """The predictions of all effects, the best first."""
    report(Progress("predicting", 0, 1))
    found = stable_ranking(_predicted(models, base, sorted(names, key=models.simplicity)), lambda one: one.after.score)
    first = tuple(Expected(one.effect, base.error * one.remaining) for one in found[: CRITERIA.ranking.finalists])
    report(Progress("predicting", 1, 1, base.error, first))
    return found


def _predicted(models: CandidateModels, base: FittedModel, names: Sequence[str]) -> list[Prediction]:
    """The prediction of each effect, also from within the ranges that a search begins with, if that promises more.

    A mass or a lag that was fitted far beyond its range may make up for the missing effect: no step leads from there
    to the machine with the effect.
    """
    predicted, within = predict(models, base, names), _within_ranges(models, base)
    if within is None:
        return predicted
    of_within = (
        replace(one, before=of.before) for one, of in zip(predict(models, within, names), predicted, strict=True)
    )
    return [min(both, key=lambda one: one.after.score) for both in zip(predicted, of_within, strict=True)]


def _within_ranges(models: CandidateModels, base: FittedModel) -> FittedModel | None:
    """The same model fitted within the ranges that a search begins with; None where it lies within them."""
    given = {*models.given.fixed, *models.given.bounds}
    start = within_ranges(models.fitness(base.effects), base.values, given)
    refit = None if start is None else models.refit(base.effects, start)
    return refit if refit is not None and refit.finite else None


def _finalists(
    models: CandidateModels, base: FittedModel, tried: Sequence[Candidate], finalists_at_least: int
) -> list[Candidate]:
    """Those of the trials that are refitted to every sample: the first, and what is as good and promises anything.

    As good as the best of them or, in a small matrix, as the last: rounding does not choose between these.
    """
    best = tried[0].score if tried else 0.0
    as_last = (
        CRITERIA.equality.practically_equal * tried[finalists_at_least - 1].score
        if len(tried) > finalists_at_least and models.is_quick(base)
        else 0.0
    )
    good = min(
        max(CRITERIA.ranking.close_trial * best, as_last), (1.0 - CRITERIA.ranking.promising) * models.trial_error(base)
    )
    return [one for i, one in enumerate(tried) if one.trial and (i < finalists_at_least or one.score < good)]


def _incumbent_as_candidate(
    models: CandidateModels, base: FittedModel, predictions: Sequence[Prediction], incumbent: FittedModel | None
) -> list[Candidate]:
    """The candidate, if any, with which a base is the model that stands beside it."""
    found = []
    for one in predictions:
        if incumbent is not None and _is_incumbent(base, one, incumbent):
            known = incumbent.reordered((*base.effects, one.effect))
            found.append(Candidate(one, known).refitted(models, base, known))
    return found


def _is_incumbent(base: FittedModel, prediction: Prediction, incumbent: FittedModel | None) -> bool:
    """Whether a base with a predicted effect is the model that stands beside it."""
    return incumbent is not None and {*base.effects, prediction.effect} == set(incumbent.effects)


def _comes_below(candidate: Candidate, error: float) -> bool:
    """Whether the error of a candidate's first refit is below this one."""
    return candidate.trial is not None and candidate.trial.local.error < error


def _is_better(again: Candidate | None, known: Candidate) -> bool:
    """Whether a model that is known was found anew, at a better optimum."""
    assert known.refit is not None
    return (
        again is not None
        and again.refit is not None
        and again.refit.error < CRITERIA.estimation.new_optimum * known.refit.error
    )


def _target(models: CandidateModels, base: FittedModel, incumbent: FittedModel | None) -> float:
    """The error below which a trial has to come to be of use, on the beginnings of the records."""
    return (
        (1.0 - CRITERIA.ranking.promising) * models.trial_error(base)
        if incumbent is None
        else CRITERIA.ranking.close_trial * models.trial_error(incumbent)
    )


def _contenders(models: CandidateModels, predictions: Sequence[Prediction]) -> list[Prediction]:
    """Those that promise most, and those that the records call for, whatever is predicted of them."""
    most = CRITERIA.ranking.contenders
    return [p for rank, p in enumerate(predictions) if rank < most or models.is_called_for(p.effect)]


def _near(models: CandidateModels, base: FittedModel, predictions: Sequence[Prediction]) -> list[Prediction]:
    """The contenders for a further effect: those that promise anything near what the best promises, if any is left."""
    if not predictions:
        return []
    near = CRITERIA.ranking.near_best * predictions[0].after.error
    return [p for p in predictions if _is_worth_a_trial(p) and p.after.error < near][: _few(models, base)]


def _overlooked(
    models: CandidateModels, base: FittedModel, predictions: Sequence[Prediction], tried: Sequence[Candidate]
) -> list[Prediction]:
    """What promises anything near what was found, where those that promised most found less than that."""
    found = min((one.trial.local.error for one in tried if one.trial is not None), default=np.inf)
    near = CRITERIA.ranking.near_best * min(found / models.trial_error(base), 1.0)
    done = {one.effect for one in tried}
    return [
        p
        for p in predictions[: _few(models, base)]
        if _is_worth_a_trial(p) and p.remaining < near and p.effect not in done
    ]


def _few(models: CandidateModels, base: FittedModel) -> int:
    """How many contenders for a further effect there may be: two fewer for each effect of the model with it."""
    return (
        CRITERIA.ranking.contenders
        if models.is_quick(base)
        else max(CRITERIA.ranking.contenders - 2 * (len(base.effects) + 1), CRITERIA.ranking.finalists)
    )


def _multistart(
    models: CandidateModels, targets: Mapping[tuple[str, ...], float], base: FittedModel, candidate: Candidate
) -> Candidate:
    """The candidate, refitted from other strengths too where its error stays above the noise: there are local optima.

    Given up is what does not come below what is `asked` beside a base.
    """
    refit, aim = candidate.refit, targets.get(base.effects, np.inf)
    if refit is None or models.at_floor(refit):
        return candidate
    starts = [*_strong_starts(models, base, refit), *_perturbed_starts(models, refit)]
    for _ in range(CRITERIA.estimation.convergence_rounds):
        other = models.better_optimum(refit, starts, aim)
        if other is None:
            break
        refit, starts = other, _perturbed_starts(models, other)
    return candidate if refit is candidate.refit else candidate.refitted(models, base, refit)


def _strong_starts(models: CandidateModels, base: FittedModel, refit: FittedModel) -> list[dict[str, float]]:
    """The model without the effect that a refit added, and that effect at large strengths of the refit's sign."""
    symbol = models.strength(refit.effects[-1])
    lower, upper = refit.fitness.space.reach(symbol, {**refit.values, **base.values})
    end = lower if refit.values[symbol] < 0 else upper
    added = models.effects[refit.effects[-1]].added[1:]
    shape = {p.in_equations: refit.values[p.in_equations] for p in added if p.in_equations in refit.values}
    return [{**base.values, **shape, symbol: share * end} for share in CRITERIA.ranking.strong_starts]


def _perturbed_starts(models: CandidateModels, refit: FittedModel) -> list[dict[str, float]]:
    """The model of a refit, with the effect that it added weaker and stronger: what plays or sticks has optima nearby.

    Between two of them lies where one more reversal of the way shows in the record.
    """
    symbol = models.strength(refit.effects[-1])
    lower, upper = refit.fitness.space.reach(symbol, refit.values)
    return [
        {**refit.values, symbol: float(np.clip(s * refit.values[symbol], lower, upper))}
        for s in CRITERIA.ranking.perturbed_starts
    ]


def _is_worth_a_trial(prediction: Prediction) -> bool:
    """Whether a prediction is worth a refit: by a part of what is asked for in the end."""
    return prediction.reduction > CRITERIA.ranking.promising or (
        prediction.offset_likelihood_gain > CRITERIA.ranking.offset_gain
        and prediction.before.offset > CRITERIA.evidence.level
    )

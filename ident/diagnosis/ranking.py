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
from ident.diagnosis.screening import Prediction, predict
from ident.diagnosis.tie_breaking import stable_minimum, stable_ranking
from ident.parallel import each
from ident.progress import Expected, Progress, Report

Item = TypeVar("Item")

Base = tuple[FittedModel, Sequence[str]]
"""A model, and the effects that could be added to it."""


Heard = Callable[[list[Candidate]], None]
"""Told of the candidates of one model as far as each has come, while the ranking goes on."""


def _unheard(_candidates: list[Candidate]) -> None:
    """Keep nothing."""


def rank(
    models: CandidateModels, base: FittedModel, names: Sequence[str], report: Report, thorough: bool = True,
    strong: bool = False, heard: Heard = _unheard,
) -> list[Candidate]:  # fmt: skip
    """The candidates, best first.

    `thorough`: more are refitted, and also where nothing promises to help. `strong`: from strong effects, too, which a
    promise made with the fitted parameters does not see where these have gone far astray for want of the effect.
    """
    return rank_each(models, [(base, names)], report, thorough, strong, heard=heard)[0]


def rank_each(
    models: CandidateModels, bases: Sequence[Base], report: Report, thorough: bool = True, strong: bool = False,
    beside: FittedModel | None = None, heard: Heard = _unheard,
) -> list[list[Candidate]]:  # fmt: skip
    """The same for several models, with what is refitted for all of them side by side.

    Where only what is about as good as a model `beside` them counts, the others are given up on the way; that model
    itself stands among the candidates as it is, or as a refit from a base finds it, where that is better.
    """
    promised = [_promised(models, base, names, report) for base, names in bases]
    heard(_so_far(promised[0]))
    models_of = [base for base, _ in bases]
    contenders = [
        of[: CRITERIA.ranking.contenders] if thorough else _near(models, base, of)
        for base, of in zip(models_of, promised, strict=True)
    ]
    sure, done = CRITERIA.ranking.finalists if thorough else 2, 0
    asked = {base.effects: _asked(models, base, beside) for base in models_of}
    anew = CRITERIA.ranking.found_again * models.trial_error(beside) if beside is not None else np.inf

    def trial(base: FittedModel, prediction: Prediction) -> Candidate:
        nonlocal done
        aim = anew if _is(base, prediction, beside) else asked[base.effects]
        candidate = _tried(models, base, prediction, aim, strong)
        done += 1
        report(Progress("trying", done, sum(map(len, contenders)) + sure * len(bases)))
        return candidate

    tried = [
        in_rank_order(models, [one for one in ones if not _is(base, one.prediction, beside) or _comes_below(one, anew)])
        for base, ones in zip(models_of, _in_turn(models, models_of, promised, contenders, trial), strict=True)
    ]
    heard(_so_far(promised[0], tried[0]))
    finalists = [_finalists(models, base, ones, sure) for base, ones in zip(models_of, tried, strict=True)]

    def final(base: FittedModel, candidate: Candidate) -> Candidate:
        nonlocal done
        confirmed = _confirmed(models, base, candidate)
        done += 1
        report(Progress("confirming", done, sum(map(len, contenders)) + sum(map(len, finalists))))
        return confirmed

    found = [in_rank_order(models, ones) for ones in _side_by_side(final, models_of, finalists)]
    heard(_so_far(promised[0], tried[0], found[0]))
    report(Progress("confirming", done, done + 1))
    deeper = CRITERIA.ranking.multistart_finalists if thorough else 1
    elsewhere = partial(_elsewhere, models, asked if beside else {})
    farther = _side_by_side(elsewhere, models_of, [ones[:deeper] for ones in found])
    return [
        _joined(models, base, of, stages, beside)
        for base, of, *stages in zip(models_of, promised, tried, found, farther, strict=True)
    ]


def _so_far(promised: Sequence[Prediction], *stages: Sequence[Candidate]) -> list[Candidate]:
    """The candidates by how far they came, those that came as far by their score."""
    came = {one.effect: one for one in chain(*stages)}
    listed = [came.get(one.effect, Candidate(one)) for one in promised]
    return sorted(listed, key=lambda one: (one.stage, one.score))


def _in_turn(
    models: CandidateModels, bases: Sequence[FittedModel], promised: Sequence[Sequence[Prediction]],
    contenders: list[list[Prediction]], trial: Callable[[FittedModel, Prediction], Candidate],
) -> list[list[Candidate]]:  # fmt: skip
    """A trial of each base's contenders, to which what they pass over is added, and then of that."""
    first = _side_by_side(trial, bases, contenders)
    passed_over = [_passed_over(models, *of) for of in zip(bases, promised, first, strict=True)]
    contenders += passed_over
    second = _side_by_side(trial, bases, passed_over)
    return [[*ones, *more] for ones, more in zip(first, second, strict=True)]


def _joined(
    models: CandidateModels, base: FittedModel, promised: Sequence[Prediction], stages: Sequence[Sequence[Candidate]],
    beside: FittedModel | None,
) -> list[Candidate]:  # fmt: skip
    """The candidates as far as each came; the model `beside` the base as it is, unless it was found anew and better."""
    came = {one.effect: one for one in chain(*stages)}
    came |= {one.effect: one for one in _met(base, promised, beside) if not _is_better(came.get(one.effect), one)}
    return in_rank_order(models, [came.get(one.effect, Candidate(one)) for one in promised])


def deepened(models: CandidateModels, base: FittedModel, ranking: Sequence[Candidate]) -> list[Candidate]:
    """The ranking of a small matrix, once all its finalists are looked for elsewhere; as it is of a large one."""
    if not _is_quick(models, base):
        return list(ranking)
    finalists, rest = ranking[: CRITERIA.ranking.finalists], ranking[CRITERIA.ranking.finalists :]
    farther = each(partial(_elsewhere, models, {}, base), finalists[CRITERIA.ranking.multistart_finalists :])
    return in_rank_order(models, [*finalists[: CRITERIA.ranking.multistart_finalists], *farther, *rest])


def _tried(models: CandidateModels, base: FittedModel, prediction: Prediction, aim: float, strong: bool) -> Candidate:
    """A candidate after its first refit, which has to come below `aim`; from strong effects, too, where asked."""
    refit = models.trial((*base.effects, prediction.effect), prediction.starts, aim)
    if strong:
        other = models.multistart(refit, _strong(models, base, refit), min(aim, refit.local.error))
        refit = stable_minimum([refit, other], lambda r: r.local.error)
    return Candidate(prediction, refit if refit.finite else None)


def _confirmed(models: CandidateModels, base: FittedModel, candidate: Candidate) -> Candidate:
    """A candidate refitted to every sample."""
    assert candidate.trial is not None
    refit = models.refit((*base.effects, candidate.effect), candidate.trial.values)
    return candidate.refitted(base, refit) if refit.finite else replace(candidate, trial=None)


def _side_by_side(
    function: Callable[[FittedModel, Item], Candidate], bases: Sequence[FittedModel], items: Sequence[Sequence[Item]]
) -> list[list[Candidate]]:
    """`function` of each base and each of its items, all of them at once."""
    todo = [(number, base, item) for number, base in enumerate(bases) for item in items[number]]
    done = each(lambda one: function(one[1], one[2]), todo)
    return [[made for (of, _, _), made in zip(todo, done, strict=True) if of == number] for number in range(len(bases))]


def _promised(models: CandidateModels, base: FittedModel, names: Sequence[str], report: Report) -> list[Prediction]:
    """What every effect promises, the best first."""
    report(Progress("predicting", 0, 1))
    found = stable_ranking(predict(models, base, sorted(names, key=models.simplicity)), lambda one: one.after.score)
    first = tuple(Expected(one.effect, base.error * one.remaining) for one in found[: CRITERIA.ranking.told_at_once])
    report(Progress("predicting", 1, 1, base.error, first))
    return found


def _finalists(models: CandidateModels, base: FittedModel, tried: Sequence[Candidate], sure: int) -> list[Candidate]:
    """Those of the trials that are refitted to every sample: the first, and what is as good and promises anything.

    As good as the best of them or, in a small matrix, as the last: rounding does not choose between these.
    """
    best = tried[0].score if tried else 0.0
    as_last = (
        CRITERIA.significance.practically_equal * tried[sure - 1].score
        if len(tried) > sure and _is_quick(models, base)
        else 0.0
    )
    good = min(
        max(CRITERIA.ranking.close_trial * best, as_last), (1.0 - CRITERIA.ranking.promising) * models.trial_error(base)
    )
    return [one for i, one in enumerate(tried) if one.trial and (i < sure or one.score < good)]


def _met(base: FittedModel, predictions: Sequence[Prediction], beside: FittedModel | None) -> list[Candidate]:
    """The candidate, if any, with which a base is the model that stands beside it."""
    found = []
    for one in predictions:
        if beside is not None and _is(base, one, beside):
            known = beside.reordered((*base.effects, one.effect))
            found.append(Candidate(one, known).refitted(base, known))
    return found


def _is(base: FittedModel, prediction: Prediction, beside: FittedModel | None) -> bool:
    """Whether a base with a predicted effect is the model that stands beside it."""
    return beside is not None and {*base.effects, prediction.effect} == set(beside.effects)


def _comes_below(candidate: Candidate, error: float) -> bool:
    """Whether the first refit of a candidate leaves less than so much."""
    return candidate.trial is not None and candidate.trial.local.error < error


def _is_better(anew: Candidate | None, known: Candidate) -> bool:
    """Whether a model that is known was found anew, at a better optimum."""
    assert known.refit is not None
    return (
        anew is not None
        and anew.refit is not None
        and anew.refit.error < CRITERIA.ranking.found_again * known.refit.error
    )


def _asked(models: CandidateModels, base: FittedModel, beside: FittedModel | None) -> float:
    """The error below which a trial has to come to be of use, on the beginnings of the records."""
    return (
        (1.0 - CRITERIA.ranking.promising) * models.trial_error(base)
        if beside is None
        else CRITERIA.ranking.close_trial * models.trial_error(beside)
    )


def _near(models: CandidateModels, base: FittedModel, predictions: Sequence[Prediction]) -> list[Prediction]:
    """The contenders for a further effect: those that promise anything near what the best promises."""
    near = CRITERIA.ranking.near_best * predictions[0].after.error
    return [p for p in predictions if _promises(p) and p.after.error < near][: _few(models, base)]


def _passed_over(
    models: CandidateModels, base: FittedModel, predictions: Sequence[Prediction], tried: Sequence[Candidate]
) -> list[Prediction]:  # fmt: skip
    """What promises anything near what was found, where those that promised most found less than that."""
    found = min((one.trial.local.error for one in tried if one.trial is not None), default=np.inf)
    near = CRITERIA.ranking.near_best * min(found / models.trial_error(base), 1.0)
    done = {one.effect for one in tried}
    return [
        p for p in predictions[: _few(models, base)] if _promises(p) and p.remaining < near and p.effect not in done
    ]


def _few(models: CandidateModels, base: FittedModel) -> int:
    """How many contenders for a further effect there may be."""
    return (
        CRITERIA.ranking.contenders
        if _is_quick(models, base)
        else max(CRITERIA.ranking.further_contenders - 2 * len(base.effects), CRITERIA.ranking.finalists)
    )


def _is_quick(models: CandidateModels, base: FittedModel) -> bool:
    """Whether a matrix is so small that refits take next to nothing."""
    steps = int(base.fitness.steps(base.fitness.space.values(base.point[None])).max())
    return steps * sum(run.length for run in models.runs) < CRITERIA.ranking.quick_steps


def _elsewhere(
    models: CandidateModels, asked: Mapping[tuple[str, ...], float], base: FittedModel, candidate: Candidate
) -> Candidate:  # fmt: skip
    """The candidate, refitted from other strengths too where its error stays above the noise: there are local optima.

    Given up is what does not come below what is `asked` beside a base.
    """
    refit, aim = candidate.refit, asked.get(base.effects, np.inf)
    if refit is None or models.at_floor(refit):
        return candidate
    starts = [*_strong(models, base, refit), *_shaken(models, refit)]
    for _ in range(CRITERIA.ranking.multistart_rounds):
        other = models.better_optimum(refit, starts, aim)
        if other is None:
            break
        refit, starts = other, _shaken(models, other)
    return candidate if refit is candidate.refit else candidate.refitted(base, refit)


def _strong(models: CandidateModels, base: FittedModel, refit: FittedModel) -> list[dict[str, float]]:
    """The model without the effect that a refit added, and that effect at large strengths of the refit's sign."""
    symbol = models.strength(refit.effects[-1])
    lower, upper = refit.fitness.space.bounds({**refit.values, **base.values})[symbol]
    end = lower if refit.values[symbol] < 0 else upper
    added = models.effects[refit.effects[-1]].added[1:]
    shape = {p.in_equations: refit.values[p.in_equations] for p in added if p.in_equations in refit.values}
    return [{**base.values, **shape, symbol: share * end} for share in CRITERIA.ranking.strong_starts]


def _shaken(models: CandidateModels, refit: FittedModel) -> list[dict[str, float]]:
    """The model of a refit, with the effect that it added weaker and stronger: what plays or sticks has optima nearby.

    Between two of them lies where one more reversal of the way shows in the record.
    """
    symbol = models.strength(refit.effects[-1])
    lower, upper = refit.fitness.space.bounds(refit.values)[symbol]
    return [
        {**refit.values, symbol: float(np.clip(s * refit.values[symbol], lower, upper))}
        for s in CRITERIA.ranking.shaken_starts
    ]


def _promises(prediction: Prediction) -> bool:
    """Whether a prediction is worth a refit: by a part of what is asked for in the end."""
    return prediction.reduction > CRITERIA.ranking.promising or (
        prediction.offset_likelihood_gain > CRITERIA.ranking.offset_gain
        and prediction.before.offset > CRITERIA.significance.offset
    )

"""The total delay of a machine, and the lags and delays that cause it, as far as the data determine them.

A model has its lag at one place. Where a delay, or a lag at another place, explains the data as well, the time constant
is no property of that stage: the data determine only the delay T of the response to a slow command, see
:mod:`ident.fit.low_frequency_delay`. Each of two lags may fix the other, where two other lags do as well: these are
compared as pairs.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain, combinations

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.evidence import separation
from ident.diagnosis.evidence.comparison import compare
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.ladder import without_effect
from ident.diagnosis.model_comparison import indistinguishable
from ident.fit.low_frequency_delay import is_late
from ident.fit.result import Combination
from ident.parallel import each
from ident.parameter import Parameter, Starts


@dataclass(frozen=True)
class TotalDelay:
    """T with its standard error, s; its parameter in the model, and the effects that explain the data as well in its
    place.

    `before` is T of the fitted model, where effects were added to it and its T is determined.
    """

    fitted: Combination
    parameter: Parameter
    in_place: tuple[str, ...]
    before: Combination | None = None


def total_delay(models: CandidateModels, base: FittedModel, refit: FittedModel) -> TotalDelay | None:
    """The total delay of a model with one searched time constant; `base` is the model before effects were added.

    None where T is not determined, or no other effect does as well.
    """
    found = next(refit.slow_lags(), None)
    constants = list(_time_constants(models, refit))
    if found is None or len(constants) != 1:
        return None
    (constant,) = constants
    least = refit.space.bounds(refit.values)[constant.in_equations][0]
    fixed = {**models.given.fixed, constant.name: least}
    short = models.with_given(replace(models.given, fixed=fixed))
    start = {**refit.values, constant.in_equations: least}

    def other(effect: str) -> FittedModel:
        at = {models.strength(effect): refit.values[constant.in_equations]}
        return short.refit((*refit.effects, effect), start | at, way=way)

    error = refit.local.error
    way = replace(CRITERIA.estimation.trial, aim=CRITERIA.ranking.close_trial * error, enough=error)
    names = [name for name, effect in models.effects.items() if is_late(effect) and name not in refit.effects]
    names = [name for name in names if models.fit_together((*refit.effects, name))]
    tried = [one for one in each(other, names) if one.finite]
    alike = tuple(one.effects[-1] for one in tried if _alike(one, refit))  # a time constant less, a lag or delay more
    before = next(base.slow_lags(), None) if base is not refit else None
    return TotalDelay(found, constant, alike, before) if alike else None


def _alike(first: FittedModel, second: FittedModel) -> bool:
    """Whether two models of as many parameters are indistinguishable by the data of the fit."""
    return separation.indistinguishable(compare(first.residuals_fitted, second.residuals_fitted))


def _time_constants(models: CandidateModels, refit: FittedModel) -> Iterator[Parameter]:
    """Those of the machine itself that a search moves."""
    for parameter in models.preset.parameters:
        if parameter.start is Starts.TIME and parameter.in_equations in refit.space.names:
            yield parameter


def lag_ambiguities(models: CandidateModels, refit: FittedModel, added: Sequence[str]) -> list[tuple[str, ...]]:
    """For each two lags or delays that were added, these and all that, two at a time, do as well in their places.

    Only where there are such others: each by itself may be told from every other while the second one stays.
    """
    times = [
        name for name, effect in models.effects.items() if is_late(effect) and effect.strength.start is Starts.TIME
    ]
    free, found = [name for name in times if name not in refit.effects], []
    pairs = list(combinations([name for name in added if name in times], 2))
    asked = CRITERIA.ranking.close_trial * models.trial_error(refit) if pairs else 0.0
    for pair in pairs:
        rest = tuple(name for name in refit.effects if name not in pair)
        others = [two for two in combinations(free, 2) if models.fit_together((*rest, *two))]
        tried = each(partial(_in_place_of, models, refit, pair, asked), others)
        as_good = [two for two, good in zip(others, tried, strict=True) if good]
        if as_good:
            found.append(tuple(dict.fromkeys((*pair, *chain(*as_good)))))
    return found


def _in_place_of(
    models: CandidateModels, refit: FittedModel, pair: tuple[str, str], asked: float, two: tuple[str, str]
) -> bool:
    """Whether two others do as well in the place of a pair, but for chance: a first refit has to come below `asked`."""
    rest = tuple(name for name in refit.effects if name not in pair)
    values = without_effect(without_effect(refit.values, pair[0]), pair[1])
    first, second = (refit.values[models.strength(name)] for name in pair)
    one, other = map(models.strength, two)
    starts = [{**values, one: first, other: second}, {**values, one: second, other: first}]
    trial = models.trial((*rest, *two), starts, asked)
    if not trial.local.error < asked:
        return False
    found = models.refit(trial.effects, trial.values)
    return found.finite and indistinguishable(refit, found)

"""How late a machine answers, and by which of its lags and delays as far as the data tell it.

A model has its lag at one place because it has to be somewhere. Where a delay, or a lag elsewhere, does as well in its
place, the time constant is no property of that stage: the time T by which a slow command is answered late is what is
known, see :mod:`ident.fit.slow_answer`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from ident.diagnosis.family import ModelFamily
from ident.diagnosis.refit import Refit
from ident.diagnosis.significance import improvement
from ident.fit.levenberg_marquardt import Way
from ident.fit.result import Combination
from ident.fit.slow_answer import is_late
from ident.parallel import each
from ident.parameter import Parameter

_NEAR = 1.05  # times the model's error: what cannot come below it does not as well
_ROUGHLY = Way(1e-4, 12, rough=1e-3)  # of a refit that is only asked whether it does


@dataclass(frozen=True)
class Lateness:
    """T with its standard error, s; the parameter that has it in the model, and what does as well in its place.

    `before` is T of the fitted model, where something was added to it and its T is determined.
    """

    found: Combination
    parameter: Parameter
    in_place: tuple[str, ...]
    before: Combination | None = None


def lateness(models: ModelFamily, base: Refit, refit: Refit) -> Lateness | None:
    """Of a model with one time constant that is searched, which began as `base`.

    None where T is not determined, or nothing does as well.
    """
    found = next(refit.slow_lags(), None)
    constants = list(_time_constants(models, refit))
    if found is None or len(constants) != 1:
        return None
    (constant,) = constants
    least = refit.space.bounds(refit.values)[constant.in_equations][0]
    fixed = {**models.given.fixed, constant.name: least}
    short = replace(models, given=replace(models.given, fixed=fixed), _known={})
    start = {**refit.values, constant.in_equations: least}

    def other(effect: str) -> Refit:
        at = {models.strength(effect): refit.values[constant.in_equations]}
        return short.refit((*refit.effects, effect), start | at, way=way)

    way = replace(_ROUGHLY, aim=_NEAR * refit.here.error, enough=refit.here.error)
    names = [name for name, effect in models.effects.items() if is_late(effect) and name not in refit.effects]
    names = [name for name in names if models.fit_together((*refit.effects, name))]
    tried = [one for one in each(other, names) if one.finite]
    alike = tuple(
        one.effects[-1] for one in tried if improvement(one.not_held_out, refit.not_held_out).within_chance
    )  # a time constant less, a lag or delay more
    before = next(base.slow_lags(), None) if base is not refit else None
    return Lateness(found, constant, alike, before) if alike else None


def _time_constants(models: ModelFamily, refit: Refit) -> Iterator[Parameter]:
    """Those of the machine itself that a search moves."""
    for parameter in models.preset.parameters:
        if parameter.unit == "s" and parameter.in_equations in refit.space.names:
            yield parameter

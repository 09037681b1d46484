"""Bounds and held values of parameters: those of a model, and those of effects that may be added to it.

A fit has no use for a bound of an effect that its model does not have. A diagnosis has: it tries the effect, and the
bound then holds. Both read names here.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from typing import TypeVar

from ident.custom.definition import Definition, preset_with, read_effect
from ident.effects import CATALOGUE
from ident.effects.effect import Effect
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.presets import Preset
from ident.presets.angles import in_si

T = TypeVar("T")
_BY_NAME = {effect.name: effect for effect in CATALOGUE}
Value = float | str
"""A plain number, SI, or text that carries a unit, as "1 ms"."""
Bounds = Mapping[str, tuple[Value, Value]]


def with_candidates(
    model: Preset, names: Iterable[str], custom: Iterable[Definition] = (), own: Iterable[Effect] = ()
) -> Preset:
    """The model with, in addition, every effect that one of the `names` is a parameter of: it reads them all.

    `custom` are definitions of the user, `own` effects. Raises Unusable where the model has no place for an effect.
    """
    defined = (*own, *(read_effect(definition, model=model.name) for definition in custom))
    known = {**_BY_NAME, **{effect.name: effect for effect in defined}}
    there = {effect.name for effect in model.effects}
    more = dict.fromkeys(known[of] for of in map(effect_of, names) if of in known and of not in there)
    return model.with_effects((*model.effects, *more)) if more else model


def effect_of(name: str) -> str:
    """The effect that a parameter's name begins with, or the name itself: ``dead_zone`` is its strength."""
    return name.partition(".")[0]


def of_model(settings: Settings, model: Preset, candidates: Collection[str] = ()) -> Settings:
    """The settings with the bounds and values of the model alone, without those of effects that it does not have.

    `candidates` are names of effects in addition to those of the catalogue and of the settings.
    """
    own = {str(definition["name"]) for definition in settings.custom}
    absent = {*_BY_NAME, *own, *candidates} - {effect.name for effect in model.effects}

    def kept(given: Mapping[str, T]) -> dict[str, T]:
        return {name: value for name, value in given.items() if effect_of(name) not in absent}

    return replace(settings, bounds=kept(settings.bounds), fixed=kept(settings.fixed))


def bounds_in_si(bounds: Bounds, model: Preset) -> dict[str, tuple[float, float]]:
    """Bounds as numbers in SI, of parameters of the model. Raises Unusable for an empty range or an unknown name."""
    found = {name: (_si(name, lower, model), _si(name, upper, model)) for name, (lower, upper) in bounds.items()}
    for name, (lower, upper) in found.items():
        model.parameter(name).within(lower, upper)
    return found


def values_in_si(values: Mapping[str, Value], model: Preset) -> dict[str, float]:
    """Values as numbers in SI, of parameters of the model. Raises Unusable for an unknown name."""
    return {name: _si(name, value, model) for name, value in values.items()}


def _si(name: str, value: Value, model: Preset) -> float:
    return in_si(value, model.parameter(name).unit, name)


def with_candidates_given(
    fit: FitResult, bounds: Bounds, values: Mapping[str, Value] | None = None, own: Iterable[Effect] = ()
) -> FitResult:
    """The fit with bounds and held values of effects that it may be found to lack; its own model stays as it is.

    Raises Unusable for a parameter of the fitted model, whose fit is made.
    """
    values = values or {}
    if not (bounds or values):
        return fit
    before = Settings.from_json(dict(fit.settings)) if fit.settings else Settings(model=fit.model)
    model = preset_with(fit.model, fit.effects, before.custom)
    wider = with_candidates(model, (*bounds, *values), before.custom, own)
    for name in (*bounds, *values):
        if wider.parameter(name) in model.parameters:
            raise Unusable(
                "bad-option",
                f"the fit has {name}, which was searched already",
                "bounds or values",
                "make the fit again with them, or give parameters of effects that may be added",
            )
    given = replace(
        before,
        bounds={**before.bounds, **bounds_in_si(bounds, wider)},
        fixed={**before.fixed, **values_in_si(values, wider)},
    )
    return replace(fit, settings={**fit.settings, **given.to_json()})

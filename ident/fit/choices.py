"""What a notebook or a request chooses about a fit, in its own words, to the settings that they are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypedDict, cast

from ident.custom.definition import definition_of, preset_with
from ident.errors import Unusable
from ident.fit.extended import extended
from ident.fit.settings import Settings
from ident.presets.angles import in_si
from ident.words.nearest import did_you_mean

Value = float | str
"""A plain number, SI, or text that carries a unit, as "1 ms"."""


class Choices(TypedDict, total=False):
    """Fields of :class:`ident.fit.settings.Settings`; values may carry units, `custom` are definitions or their text.

    The effects that `custom` defines are in the model, whether `effects` names them or not.
    """

    model: str
    effects: Sequence[str]
    custom: Sequence[Mapping[str, Any] | str]
    method: str
    bounds: Mapping[str, tuple[Value, Value]]
    fixed: Mapping[str, Value]
    load: str
    seed: int
    options: Mapping[str, float]
    budget: float | None


def settings_of(choices: Choices, usual: Settings | None = None) -> Settings:
    """The settings, `usual` where nothing is chosen. Raises Unusable for what the model does not know."""
    given = cast(dict[str, Any], choices)
    unknown = [name for name in given if name not in Choices.__annotations__]
    if unknown:
        raise Unusable("unknown-option", f"no choice {unknown[0]!r} about a fit", "settings",
                       did_you_mean(unknown[0], Choices.__annotations__))  # fmt: skip
    chosen = {**vars(usual or Settings()), **given}
    custom = tuple(definition_of(one) for one in chosen["custom"])
    named = extended(Settings(model=chosen["model"]), chosen["effects"], custom)
    model = preset_with(named.model or Settings().model, named.effects, named.custom)

    def si(name: str, value: Value) -> float:
        return in_si(value, model.parameter(name).unit, name)

    bounds = {name: (si(name, lower), si(name, upper)) for name, (lower, upper) in chosen["bounds"].items()}
    for name, (lower, upper) in bounds.items():
        model.parameter(name).within(lower, upper)
    fixed = {name: si(name, value) for name, value in chosen["fixed"].items()}
    return Settings(**{**chosen, "effects": named.effects, "custom": named.custom, "bounds": bounds, "fixed": fixed})

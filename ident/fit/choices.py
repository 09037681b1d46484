"""What a notebook or a request chooses about a fit, in its own words, to the settings that they are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypedDict, cast

from ident.custom.definition import definition_of, preset_with
from ident.errors import Unusable
from ident.fit.added_effects import with_added_effects
from ident.fit.parameter_bounds import Value, bounds_in_si, values_in_si, with_candidates
from ident.fit.settings import Settings
from ident.preprocessing import off_steps
from ident.words.nearest import did_you_mean


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
    preprocessing: Mapping[str, bool]


def settings_of(choices: Choices, usual: Settings | None = None, candidates: bool = False) -> Settings:
    """The settings, `usual` where nothing is chosen. Raises Unusable for what the model does not know.

    With `candidates` bounds and values may be of effects, too, that a diagnosis may add to the model.
    """
    given = cast(dict[str, Any], choices)
    unknown = [name for name in given if name not in Choices.__annotations__]
    if unknown:
        raise Unusable(
            "unknown-option",
            f"no choice {unknown[0]!r} about a fit",
            "settings",
            did_you_mean(unknown[0], Choices.__annotations__),
        )
    chosen = {**vars(usual or Settings()), **given}
    custom = tuple(definition_of(one) for one in chosen["custom"])
    named = with_added_effects(Settings(model=chosen["model"]), chosen["effects"], custom)
    model = preset_with(named.model or Settings().model, named.effects, named.custom)
    if candidates:
        model = with_candidates(model, (*chosen["bounds"], *chosen["fixed"]), named.custom)
    bounds, fixed = bounds_in_si(chosen["bounds"], model), values_in_si(chosen["fixed"], model)
    settings: dict[str, Any] = {
        **chosen,
        "effects": named.effects,
        "custom": named.custom,
        "bounds": bounds,
        "fixed": fixed,
        "preprocessing": off_steps(chosen["preprocessing"]),
    }
    return Settings(**settings)

"""A fit and further effects by name: the settings of the next fit, the same for every way of asking for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ident.custom.definition import Definition, preset_with, together
from ident.errors import Unusable
from ident.fit.settings import Settings

EFFECT_THERE = "effect-there"
"""The code of a refusal to add what a fit has."""


def with_added_effects(settings: Settings, effects: Sequence[str], custom: Sequence[Definition] = ()) -> Settings:
    """The settings with further effects: those named, of the catalogue or defined, and all that `custom` defines.

    Definitions that the settings have already, of terms or own effects that were ranked, are found by name. Bounds,
    values, method and seed stay. Raises Unusable, with the nearest name, for an effect that is not known, and for one
    that is in the model already, that has no place in it or that two definitions have one name for.
    """
    wanted = tuple(dict.fromkeys((*effects, *(str(definition["name"]) for definition in custom))))
    if there := [name for name in wanted if name in settings.effects]:
        raise Unusable(
            EFFECT_THERE,
            f"the fit has {', '.join(there)} already",
            "effect",
            "add another one, or start from the fit before it",
        )
    known = together(settings.custom, custom)
    preset_with(settings.model or Settings().model, (*settings.effects, *wanted), known)
    return replace(settings, effects=(*settings.effects, *wanted), custom=known)

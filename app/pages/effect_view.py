"""An effect as the pages tell of it: its name in words, its equations and its strength."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from markupsafe import Markup

from ident.diagnosis.estimate import Found
from ident.effects.effect import Effect
from ident.equations.mathml import mathml
from ident.fit.result import Estimate
from ident.words.plus_minus import UNDETERMINED, plus_minus
from ident.words.titles import title
from schemas.result import EstimateView

Valued = Estimate | Found | EstimateView
"""A parameter with its standard error: of a fit, of a refit, of a step of the ladder."""


@dataclass(frozen=True)
class Member:
    """An effect on a card; `known` is False where neither the catalogue nor the diagnosis has it.

    `definition` is that of a user's own effect, as JSON, and `origin` says where it comes from; "" for one of the
    catalogue.
    """

    name: str
    title: str
    known: bool
    place: str
    meaning: str
    equations: tuple[Markup, ...]
    strength: str
    strength_is: str
    definition: str = ""
    origin: str = ""
    determined: bool = True


def member(name: str, effect: Effect | None, parameters: Mapping[str, Valued], own: Mapping[str, Any] | None) -> Member:
    """An effect as the page tells of it, with the strength that is among the parameters."""
    return Member(
        name=name,
        title=title(name),
        known=effect is not None,
        place=effect.place if effect else "",
        meaning=effect.meaning if effect else "",
        equations=tuple(Markup(mathml(line.text)) for line in effect.equations) if effect else (),
        strength=strength(name, parameters) or "–",
        determined=not strength(name, parameters).startswith(UNDETERMINED),
        strength_is=f"{effect.strength.symbol}, {effect.strength.meaning}" if effect else "strength",
        definition=json.dumps(own) if own is not None else "",
        origin=effect.source if own is not None and effect is not None and effect.source != effect.meaning else "",
    )


def strength(effect: str, parameters: Mapping[str, Valued]) -> str:
    """The first parameter of the effect, with standard error and unit; "" where it is not among the parameters.

    Without a standard error one that is neither held nor at a bound is not determined by the data.
    """
    own = (entry for name, entry in parameters.items() if name.startswith(f"{effect}."))
    entry = next(own, None)
    if entry is None:
        return ""
    held = isinstance(entry, Estimate | EstimateView) and (entry.fixed or entry.at_bound)
    if entry.std_error is None and not held:
        return UNDETERMINED
    return plus_minus(entry.value, entry.std_error, entry.unit)

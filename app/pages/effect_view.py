"""An effect as the pages tell of it: its name in words, its equations and its strength."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from markupsafe import Markup

from ident.diagnosis.parameter_estimate import ParameterEstimate
from ident.effects.effect import Effect
from ident.equations.mathml import mathml
from ident.fit.result import Estimate
from ident.words.plus_minus import UNDETERMINED, determined, plus_minus
from ident.words.titles import title
from schemas.result import EstimateView

Valued = Estimate | ParameterEstimate | EstimateView
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
        determined=_is_determined(_strength_of(name, parameters)),
        strength_is=f"{effect.strength.symbol}, {effect.strength.meaning}" if effect else "strength",
        definition=json.dumps(own) if own is not None else "",
        origin=effect.source if own is not None and effect is not None and effect.source != effect.meaning else "",
    )


def strength(effect: str, parameters: Mapping[str, Valued]) -> str:
    """The strength of the effect, with standard error and unit; "" where it is not among the parameters."""
    entry = _strength_of(effect, parameters)
    if entry is None:
        return ""
    if entry.std_error is None and not _is_determined(entry):
        return UNDETERMINED
    return plus_minus(entry.value, entry.std_error, entry.unit)


def _strength_of(effect: str, parameters: Mapping[str, Valued]) -> Valued | None:
    """The first parameter of the effect; None where it is not among the parameters."""
    return next((entry for name, entry in parameters.items() if name.startswith(f"{effect}.")), None)


def _is_determined(entry: Valued | None) -> bool:
    """Whether the data determine a strength: without a standard error they do not, unless it is held or at a bound."""
    if entry is None:
        return True
    held = isinstance(entry, Estimate | EstimateView) and (entry.fixed or entry.at_bound)
    return determined(entry.value, entry.std_error) and (entry.std_error is not None or held)

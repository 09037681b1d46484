"""Models and effects of the library as messages."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict
from typing import Any

from ident.custom.definition import read_effect
from ident.effects import CATALOGUE
from ident.effects.effect import Effect
from ident.equations.equation import Equation
from ident.equations.mathml import mathml
from ident.parameter import Parameter
from ident.plain import written
from ident.presets import PRESETS
from ident.presets.model import Model
from ident.presets.signal_table import signal_table
from schemas.catalogue import ChainSignalView, EffectView, EquationView, ModelView, ParameterView


def models() -> list[ModelView]:
    """Every model that can be fitted."""
    return [
        ModelView(
            name=preset.name,
            title=preset.title,
            citation=preset.citation,
            notes=list(preset.notes),
            parameters=_parameters(preset.parameters),
            equations=_equations(preset.equations),
            signals=signals(preset),
        )
        for preset in PRESETS.values()
    ]


def signals(model: Model) -> list[ChainSignalView]:
    """The signals of a model that an equation may name."""
    return [ChainSignalView(**written(one), symbol=one.symbol) for one in signal_table(model)]


def effects() -> list[EffectView]:
    """Every effect of the catalogue."""
    return [view(effect) for effect in CATALOGUE]


def custom_effect(definition: Mapping[str, Any] | str) -> EffectView:
    """A user's effect as it is understood. Raises Unusable with the character at fault."""
    return view(read_effect(definition))


def view(effect: Effect) -> EffectView:
    """An effect as it is sent."""
    return EffectView(
        name=effect.name,
        place=effect.place,
        meaning=effect.meaning,
        looks=effect.looks,
        source=effect.source,
        parameters=_parameters(effect.parameters),
        equations=_equations(effect.equations),
    )


def _parameters(parameters: Iterable[Parameter]) -> list[ParameterView]:
    return [ParameterView(**asdict(parameter)) for parameter in parameters]


def _equations(equations: Iterable[Equation]) -> list[EquationView]:
    return [EquationView(place=e.place, text=e.text, mathml=mathml(e.text), meaning=e.meaning) for e in equations]

"""Errors that refuse an effect: a chain has no place for it, or its signals have other units."""

from ident.effects.effect import Effect
from ident.errors import Unusable


def unfit(effect: Effect) -> Unusable:
    """The refusal of an effect that a model has no place for."""
    return Unusable(
        "effect-does-not-fit",
        "the model has nothing that it could act on",
        f"effect {effect.name}",
        "choose another effect, or a model that has its place",
    )


def of_state(effect: Effect, state: str) -> Unusable:
    """The refusal of an effect that redefines a state, or gives it another rate: its rate is the model's."""
    return Unusable(
        "effect-does-not-fit",
        f"{state} is a state of the model, which has its rate",
        f"effect {effect.name}",
        f"redefine a signal that the rate of {state} reads",
    )


def of_other_unit(effect: Effect, signal: str, unit: str) -> Unusable:
    """The refusal of an effect by a model whose signal has another unit than the effect is made for."""
    here = "a plain number" if unit == "1" else f"in {unit}"
    return Unusable(
        "effect-does-not-fit",
        f"it redefines {signal} in {effect.units[signal]}, which is {here} here",
        f"effect {effect.name}",
        "choose another effect, or another model",
    )

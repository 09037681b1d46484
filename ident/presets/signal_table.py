"""The signals of a model in a table: what an effect, or an equation of one's own, may read and change.

The table is made from the stages and the library of effects, so that it is that of the model whatever is exchanged.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ident.effects import CATALOGUE
from ident.effects.effect import Effect
from ident.equations.mathml import letter_and_index
from ident.presets.model import Model
from ident.stages import PLACES


@dataclass(frozen=True)
class Signal:
    """A state or signal of a chain."""

    name: str
    """What equations call it."""
    unit: str
    """SI; of a plain number "1"."""
    meaning: str
    """What it is, as a clause."""
    place: str
    """Place of the chain where it arises."""
    equation: str
    """What it is without effects."""
    changed_at: tuple[str, ...]
    """Places whose effects may redefine it: its own and those behind it."""
    changed_by: tuple[str, ...]
    """Effects that do."""

    @property
    def symbol(self) -> str:
        """How it is written: ``x_L`` for xL, ``y_fb`` for y_fb."""
        return "_".join(filter(None, letter_and_index(self.name)))


def signal_table(model: Model, effects: Iterable[Effect] = CATALOGUE) -> tuple[Signal, ...]:
    """The signals of a model in the order of its chain, and which of the effects that it can take redefine each."""
    redefined = {effect.name: {e.target for e in effect.equations} for effect in effects if model.takes(effect)}
    stages = model.core.stages
    there = {stage.place for stage in stages}
    return tuple(
        Signal(
            name=quantity.name,
            unit=quantity.unit,
            meaning=quantity.meaning,
            place=stage.place,
            equation=next(equation.text for equation in stage.equations if equation.target == quantity.name),
            changed_at=tuple(place for place in PLACES[PLACES.index(stage.place) :] if place in there),
            changed_by=tuple(effect for effect, names in redefined.items() if quantity.name in names),
        )
        for stage in stages
        for quantity in stage.publishes
    )

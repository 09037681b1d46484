"""A physical effect that a chain may lack: one strength, off at zero, at one place."""

from __future__ import annotations

from dataclasses import dataclass

from ident.expression import Equation
from ident.parameter import Parameter
from ident.stages import Quantity


@dataclass(frozen=True)
class Effect:
    """What is added to the chain at `place`.

    `strength` is the parameter with which the effect is off at 0 (the chain is then exactly unchanged), `shape` its
    other parameters; `states` are its own; `equations` redefine signals of the place and give the states' rates.
    """

    name: str
    place: str
    meaning: str
    strength: Parameter
    equations: tuple[Equation, ...]
    shape: tuple[Parameter, ...] = ()
    states: tuple[Quantity, ...] = ()
    source: str = ""

"""The servo loop of an identified machine as its stability is judged: its poles by its parameters and its gain Kp."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.chain.chain import Chain
from ident.chain.conditions import CONDITIONS
from ident.hybrid.changed_machine import ChangedMachine
from ident.hybrid.linear_plant import OUTPUT, LinearPlant
from ident.linear import LinearModel
from ident.parameter import Parameter
from ident.stability.loop import SHORTEST, Complex, LoopPart, kind_of, parts_of

Array = NDArray[np.float64]
_GIVEN = {"A", "mL", "k", "cL", "Ps", "Ir", "Nv"}
"""Conditions, which no remedy changes: a damper is put to the actuator's own damping, a piston area to Z0 and Ka."""


@dataclass(frozen=True, eq=False)
class ServoLoop:
    """A linear chain with the `values` of all its symbols, Kp among them, whose loop closes through `output`."""

    chain: Chain
    values: Mapping[str, float]
    output: str
    parts: tuple[LoopPart, ...]
    symbols: Mapping[str, str]

    @property
    def openings(self) -> tuple[str, ...]:
        """Where the gain margin is taken: at the dial."""
        return ("Kp",) if "Kp" in self.chain.symbols else ()

    def linear(self, factors: Mapping[str, Array], gains: Mapping[str, Array]) -> LinearModel:
        """The linearised loop with parts times `factors` (b,) and Kp times `gains["Kp"]` (b,)."""
        values: dict[str, Array | float] = {name: np.array([value]) for name, value in self.values.items()}
        for name, factor in factors.items():
            values[self.symbols[name]] = self.values[self.symbols[name]] * factor
        for name, factor in gains.items():
            values[name] = values[name] * factor
        model = self.chain.linearise(values, self.output)
        return model.of_states(self._observed)

    @cached_property
    def _observed(self) -> tuple[int, ...]:
        """The places of the states that the output depends on: what drives nothing is no part of the loop."""
        return self.chain.observed(self.output, {name for name, value in self.values.items() if value == 0})

    def poles(self, factors: Mapping[str, Array], gains: Mapping[str, Array]) -> Complex:
        """See :meth:`ident.stability.loop.Loop.poles`."""
        with np.errstate(all="ignore"):
            return np.asarray(np.linalg.eigvals(self.linear(factors, gains).A), complex)


def values_before(known: Mapping[str, float], loop: ServoLoop) -> dict[str, float]:
    """The values of the parts of a loop, by name, in a machine with these `known` symbols; off what it has not."""
    off = {part.name: SHORTEST if part.unit == "s" else 0.0 for part in loop.parts}
    return {name: known.get(loop.symbols[name], value) for name, value in off.items()}


def servo_loop(machine: ChangedMachine, gain: float) -> ServoLoop:
    """The loop of a machine at a gain Kp."""
    values = {**machine.values, **({"Kp": gain} if machine.has_gain else {})}
    return _loop(machine.chain, values, machine.output, machine.preset.parameters)


def plant_loop(plant: LinearPlant) -> ServoLoop:
    """The loop of a plant that a controller is designed for."""
    values = {name: plant.known[name] for name in plant.chain.symbols}
    return _loop(plant.chain, values, OUTPUT, plant.parameters)


def _loop(chain: Chain, values: Mapping[str, float], output: str, parameters: Iterable[Parameter]) -> ServoLoop:
    own = [p for p in parameters if p.in_equations in values]
    given = {name: quantity for name, quantity in CONDITIONS.items() if name in values}
    parts = (
        *parts_of(own, values),
        *(LoopPart(n, kind_of(n, q.unit), q.meaning, values[n], q.unit, n in _GIVEN) for n, q in given.items()),
    )
    symbols = {p.name: p.in_equations for p in own} | dict(zip(given, given, strict=True))
    return ServoLoop(chain, values, output, parts, symbols)

"""Kononykhin's simplified model of an actuator (section 4, Fig. 1): its parameters, and its answer to a current."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.bench.chain_response import SHOWN, chain_response
from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.response import respond
from ident.bench.speed_table import SpeedTable
from ident.cached import cached_property
from ident.chain.chain import Chain
from ident.effects.command_delay import COMMAND_DELAY
from ident.effects.second_lag import SECOND_LAG
from ident.effects.spring_load import SPRING_LOAD
from ident.effects.stiction import STICTION
from ident.rounding import ROUNDING
from ident.time_budget import check_time

Array = NDArray[np.float64]
_OF = BENCH_CRITERIA.simulation
CONSTANTS = ("T", "B", "I0", "kp", "dPfr")
FAST = (COMMAND_DELAY, SECOND_LAG, SPRING_LOAD, STICTION)
"""The effects that the compiled simulation of a bench knows; with any other the chain is simulated."""
DELAY = COMMAND_DELAY.added[0].in_equations
_STRENGTHS = tuple(
    parameter.in_equations
    for effect in (SECOND_LAG, STICTION, SPRING_LOAD, COMMAND_DELAY)
    for parameter in effect.added
)


def beyond_fast(chain: Chain) -> Chain | None:
    """The chain of a model, where it has effects that the compiled simulation does not know."""
    return chain if set(chain.effects) - set(FAST) else None


def dead_space(values: Mapping[str, Any]) -> Any:
    """Half of the range of currents in which the actuator stands: B + ΔPfr/kp; of numbers or of arrays."""
    return values["B"] + values["dPfr"] / values["kp"]


@dataclass(frozen=True)
class Answer:
    """Position (m), pressure difference of the cavities (Pa) and the current after the play, each (n,)."""

    position: Array
    pressure: Array
    after_play: Array


@dataclass(frozen=True)
class Model:
    """Blocks a to d; currents are fractions of the rated current.

    a: T I' + I = Iin                                             T (s), a single lag
    b: play of half-width B                                       B (1)
    c: V0 = f(I_BL − I0), the speed without load and friction     table (1 → m/s), I0 the zero shift
    d: V = V0 sqrt(max(0, 1 − needed/available)), available = min(kp |I_BL − I0|, Ps), needed = ΔPfr (Pa)

    At rest the pressure difference is what is available, kp (I_BL − I0); in motion what is needed, ±ΔPfr. `strengths`
    holds the parameters of effects by their names in the equations, all zero where there is none; `chain` is given
    where an effect is not one of :data:`FAST`: it then says what the actuator answers.
    """

    T: float
    B: float
    I0: float
    kp: float
    dPfr: float
    table: SpeedTable
    Ps: float = np.inf
    strengths: Mapping[str, float] = field(default_factory=dict)
    chain: Chain | None = None

    @property
    def dead_space(self) -> float:
        """See :func:`dead_space`."""
        return float(dead_space(self.values()))

    @cached_property
    def constants(self) -> Array:
        """As the compiled simulation takes them."""
        of_effects = [self.strengths.get(name, 0.0) for name in _STRENGTHS]
        return np.array([self.T, self.B, self.I0, self.kp, self.dPfr, self.Ps, *of_effects])

    @property
    def delay(self) -> float:
        """Of the current, s."""
        return float(self.constants[-1])

    @property
    def is_plain(self) -> bool:
        """The four blocks, with a delay at most: no second lag, no stiction, no load, no other effect."""
        return self.chain is None and not np.any(self.constants[len(CONSTANTS) + 1 : len(CONSTANTS) + 4])

    def speed(self, behind_play: Array) -> Array:
        """Blocks c and d without a load: the speed (m/s) at currents behind the play (rated currents), (n,)."""
        current = behind_play - self.I0
        available = np.minimum(self.kp * np.abs(current), self.Ps)
        share = np.sqrt(np.maximum(1.0 - self.dPfr / np.maximum(available, 1.0), 0.0))
        return np.asarray(self.table.speed(current) * share)

    def with_values(self, values: Mapping[str, float]) -> Model:
        """The model with other values of constants, of effects, or of the table (``V_p5``: at +5 %)."""
        own: dict[str, Any] = {name: value for name, value in values.items() if name in CONSTANTS}
        strengths = {**self.strengths, **{name: value for name, value in values.items() if "__" in name}}
        return replace(self, **own, strengths=strengths, table=self.table.with_values(values))

    def values(self) -> dict[str, float]:
        """Every constant, every speed of the table and every parameter of effects by name."""
        return {name: float(getattr(self, name)) for name in CONSTANTS} | self.table.values() | dict(self.strengths)

    def answer(
        self, current: Array, rate: float, hold: str = "linear", start: float = 0.0, steps: int | None = None
    ) -> Answer:
        """What a record of the current (fractions of the rated one) makes of an actuator that stands at `start` (m).

        The play begins where it holds the current nearest to the zero shift. A sample is divided until a step is no
        longer than a share of T and a few ms.
        """
        check_time()
        if self.chain is not None:
            return Answer(*(by_chain([self], current, rate, hold, start, what)[0] for what in SHOWN))
        longest = min(_OF.longest_step, _OF.step_of_lag * self.T)
        divided = max(1, int(np.ceil(1.0 / (rate * longest) - ROUNDING))) if steps is None else steps
        driven = np.ascontiguousarray(current, dtype=float)
        play = float(np.clip(self.I0, driven[0] - self.B, driven[0] + self.B))
        out = np.empty((3, len(driven)))
        respond(
            driven,
            1.0 / rate,
            divided,
            hold == "zoh",
            self.constants,
            self.table.nodes,
            self.table.pieces,
            np.array([start, driven[0], driven[0], play]),
            out,
        )
        return Answer(*out)


def by_chain(models: Sequence[Model], current: Array, rate: float, hold: str, start: float, what: str) -> Array:
    """One answer of models that differ in their values alone, by their chain: (models, n)."""
    chain, values = models[0].chain, [model.values() for model in models]
    if chain is None:
        raise ValueError("models of the fast simulation have no chain")
    stacked = {name: np.array([own[name] for own in values]) for name in values[0]}
    return chain_response(chain, stacked, models[0].Ps, current, rate, hold, start, what)


@dataclass(frozen=True, eq=False)
class Models:
    """Models that differ in their values alone, as a compiled simulation takes them."""

    each: tuple[Model, ...]
    constants: Array
    pieces: Array

    @classmethod
    def of(cls, models: Sequence[Model]) -> Models:
        """Those models."""
        constants, pieces = [model.constants for model in models], [model.table.pieces for model in models]
        return cls(tuple(models), np.array(constants), np.array(pieces))

    def __len__(self) -> int:
        return len(self.each)

    def some(self, which: NDArray[np.intp]) -> Models:
        """Some of them, by their places."""
        return Models(tuple(self.each[i] for i in which), self.constants[which], self.pieces[which])

"""Kononykhin's simplified model of an actuator (section 4, Fig. 1): its parameters, and its answer to a current."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.bench.response import respond
from ident.bench.speed_table import SpeedTable

Array = NDArray[np.float64]
CONSTANTS = ("T", "B", "I0", "kp", "dPfr")
MISSING = ("second_lag", "stiction", "load", "delay")
"""What the four blocks lack: s, Pa above ΔPfr to break loose, Pa/m of position, s."""


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

    At rest the pressure difference is what is available, kp (I_BL − I0); in motion what is needed, ±ΔPfr. `extra`
    holds what the four blocks lack, all zero: see :data:`MISSING`; `centre` (m) is where the lacking load is zero.
    """

    T: float
    B: float
    I0: float
    kp: float
    dPfr: float
    table: SpeedTable
    Ps: float = np.inf
    extra: Mapping[str, float] = field(default_factory=dict)
    centre: float = 0.0

    @property
    def dead_space(self) -> float:
        """See :func:`dead_space`."""
        return float(dead_space(self.values()))

    @cached_property
    def constants(self) -> Array:
        """As the compiled simulation takes them."""
        lacking = [self.extra.get(name, 0.0) for name in MISSING]
        return np.array([self.T, self.B, self.I0, self.kp, self.dPfr, self.Ps, *lacking, self.centre])

    def with_values(self, values: Mapping[str, float]) -> Model:
        """The model with other values of constants, of extras, or of the table (``V_p5``: at +5 %)."""
        own = {name: value for name, value in values.items() if name in CONSTANTS}
        extra = {**self.extra, **{name: value for name, value in values.items() if name in MISSING}}
        return replace(self, **own, extra=extra, table=self.table.with_values(values))

    def values(self) -> dict[str, float]:
        """Every constant and every speed of the table by name."""
        return {name: float(getattr(self, name)) for name in CONSTANTS} | self.table.values()

    def answer(
        self, current: Array, rate: float, hold: str = "linear", start: float = 0.0, steps: int | None = None
    ) -> Answer:
        """What a record of the current (fractions of the rated one) makes of an actuator that stands at `start` (m).

        The play begins where it holds the current nearest to the zero shift. A sample is divided until a step is no
        longer than a tenth of T, and 2.5 ms.
        """
        longest = min(2.5e-3, max(0.1 * self.T, 5e-4))
        divided = max(1, int(np.ceil(1.0 / (rate * longest) - 1e-9))) if steps is None else steps
        driven = np.ascontiguousarray(current, dtype=float)
        play = float(np.clip(self.I0, driven[0] - self.B, driven[0] + self.B))
        out = np.empty((3, len(driven)))
        respond(
            driven, 1.0 / rate, divided, hold == "zoh", self.constants, self.table.nodes, self.table.pieces,
            np.array([start, driven[0], driven[0], play]), out,
        )  # fmt: skip
        return Answer(*out)

"""A feedback loop as its stability is judged: poles as functions of its parts and of its gain."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ident.parameter import Parameter
from ident.words.engineering import quantity
from ident.words.number import trimmed

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
GAIN, DELAY, LAG, OIL, DAMPING = "gain", "delay", "valve lag", "oil column", "damping"
LOAD, SHARE, OTHER = "load", "numerical share", "other"
SAMPLES = "samples"
SHORTEST = 1e-5
"""s: a lag or a delay that is off is one so short, 0.2° at 50 Hz: equations of states divide by it."""
CHANGEABLE = {GAIN: "reduce", DELAY: "reduce", LAG: "", OIL: "", DAMPING: "", SHARE: "reduce"}
"""The parts that a remedy may change: only to less, or either way. A load is what the test is about, and stays."""
_KINDS = {
    "Kp": GAIN, "Z0": GAIN, "Kv": GAIN, "tau": LAG, "wv": LAG, "zv": LAG, "Ka": OIL, "A": OIL, "Cl": DAMPING,
    "c0": DAMPING, "cL": DAMPING, "m0": LOAD, "mL": LOAD, "k": LOAD, "k0": LOAD,
    "loop_delay__delay": DELAY, "sensor_lag__time_constant": DELAY, "second_lag__time_constant": LAG,
    "valve_second_order__inverse_frequency": LAG, "pressure_feedback__gain": DAMPING,
}  # fmt: skip
"""The part that a quantity of the equations belongs to, by its name there."""


@dataclass(frozen=True)
class LoopPart:
    """One quantity of a loop, `name` as the user calls it, with its value in `unit` (SI); `kind` is the part it is of.

    `fixed`: no remedy changes it, for another quantity of the loop has the same effect, or it is given.
    """

    name: str
    kind: str
    meaning: str
    value: float
    unit: str
    fixed: bool = False


TWINS = frozenset({"Z0", "Kv"})
"""Factors of Kp: the dial is what is turned."""


def parts_of(parameters: Iterable[Parameter], values: Mapping[str, float]) -> tuple[LoopPart, ...]:
    """The parts of a loop that are parameters of its machine; `values` are by the names of the equations."""
    return tuple(
        LoopPart(
            p.name, kind_of(p.in_equations, p.unit), p.meaning, values[p.in_equations], p.unit, p.in_equations in TWINS
        )
        for p in parameters
        if p.in_equations in values
    )


def kind_of(symbol: str, unit: str) -> str:
    """The part of the loop that a quantity of the equations belongs to; of an unknown time the delay."""
    return _KINDS.get(symbol, DELAY if unit == "s" else OTHER)


def from_to(before: float, after: float, unit: str) -> str:
    """ "2 ms to 6 ms": a change of a value in its unit; a time that is next to nothing is 0."""
    return f"{_value(before, unit)} to {_value(after, unit)}"


def _value(value: float, unit: str) -> str:
    if unit in ("", "1"):
        return trimmed(value)
    if unit == SAMPLES:
        return f"{trimmed(value)} samples"
    return quantity(0.0 if unit == "s" and value <= SHORTEST else value, unit)


class Loop(Protocol):
    """What a judgement of stability needs. `openings` are the places where the loop's gain may rise, by name."""

    @property
    def parts(self) -> tuple[LoopPart, ...]:
        """The quantities that may be changed."""
        ...

    @property
    def openings(self) -> tuple[str, ...]:
        """Where the gain margin is taken."""
        ...

    def poles(self, factors: Mapping[str, Array], gains: Mapping[str, Array]) -> Complex:
        """Poles (b, n) in 1/s with parts times `factors` (b,), and the gain at openings times `gains` (b,).

        Where both are empty b is 1.
        """
        ...

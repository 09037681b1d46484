"""The conditions under which a machine was tested: what its parameters may depend on from one set to another."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ident.rig.provenance import Provenance
from ident.run import Run
from ident.words.number import trimmed

PREFIX = "condition."
"""Prefix of the name of a condition among the names of parameters, in queries and statistics."""


@dataclass(frozen=True)
class Condition:
    """What it is called, its SI `unit`, and the unit `shown` to people: SI value = `factor` × shown + `offset`."""

    title: str
    unit: str
    shown: str
    factor: float = 1.0
    offset: float = 0.0

    def said(self, value: float) -> str:
        """A value, SI, in words: "60 °C"."""
        return f"{trimmed((value - self.offset) / self.factor)} {self.shown}".strip()


CONDITIONS: Mapping[str, Condition] = {
    "temperature": Condition("oil temperature", "K", "°C", offset=273.15),
    "supply_pressure": Condition("supply pressure", "Pa", "bar", 1e5),
    "oil_age": Condition("age of the oil", "s", "h", 3600.0),
    "cycles": Condition("load cycles", "1", ""),
}
TEMPERATURE = "temperature"


def conditions_of(test: Provenance, supply_pressure: float | None, runs: Sequence[Run]) -> dict[str, float]:
    """Those that are known, SI: what is stated of the test, else the mean of what its runs recorded.

    A recorded supply pressure comes before that which is stated of the machine.
    """
    temperature, supply = (_mean(runs, channel) for channel in ("temperature", "supply_pressure"))
    known = {
        "temperature": temperature if test.oil_temperature is None else test.oil_temperature,
        "supply_pressure": supply_pressure if supply is None else supply,
        "oil_age": test.oil_age,
        "cycles": test.cycles,
    }
    return {name: value for name, value in known.items() if value is not None}


def _mean(runs: Sequence[Run], channel: str) -> float | None:
    means = [float(np.mean(run.channels[channel])) for run in runs if channel in run.channels]
    return float(np.mean(means)) if means else None

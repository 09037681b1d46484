"""`python -m tests.bench.recovery [COUNT [FIRST]]`: how well scattered actuators are found again, a row a quantity."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ident.bench.acceptance import found_quantities
from ident.bench.analysis import Analysis, analyse
from ident.bench.estimate import BenchEstimate
from ident.bench.model import Model
from tests.bench.sets import as_set, true_model
from tests.reference import kononykhin_reference as reference


@dataclass(frozen=True)
class Found:
    """One actuator: what was found, and the truth."""

    truth: Model
    analysis: Analysis
    records: list[reference.Record]

    @cached_property
    def quantities(self) -> dict[str, BenchEstimate]:
        """Those of the sheet, as found."""
        return found_quantities(self.analysis)

    def relative(self, name: str) -> float:
        """|found − true| / true of a quantity of the sheet."""
        true = {
            "hysteresis": self.truth.B,
            "dead_space": self.truth.dead_space,
            "kp": self.truth.kp,
            "friction": self.truth.dPfr,
            "T": self.truth.T,
        }[name]
        return abs(self.quantities[name].value / true - 1)

    @property
    def zero_shift(self) -> float:
        """|found − true| in rated currents."""
        return abs(self.quantities["zero_shift"].value - self.truth.I0)

    def position_error(self, amplitude: float, frequency: float, by_steps: bool = False) -> float:
        """RMS / deviation of the assembled model's position against the position before the converter."""
        (record,) = (r for r in self.records if r.amplitude == amplitude and r.frequency == frequency)
        true = 1e-3 * record.true_position
        model = self.analysis.steps if by_steps else self.analysis.model
        found = model.answer(record.current / 100, reference.RATE, start=true[0]).position
        return float(np.std(found - true) / np.std(true))


def recover(seed: int) -> Found:
    """The actuator of a number, recorded by the reference and analysed."""
    truth = reference.scattered(seed)
    records = reference.full_set(truth, seed)
    return Found(true_model(truth), analyse(as_set(truth, records)), records)


def main(count: int, first: int = 0) -> None:
    """Print the rows of the table, for actuators from a first number on."""
    found = [recover(seed) for seed in range(first, first + count)]
    for name in ("hysteresis", "dead_space", "kp", "friction", "T"):
        show(name, [actuator.relative(name) for actuator in found])
    show("zero shift, of rated current", [actuator.zero_shift for actuator in found])
    show("hysteresis, static alone", [abs(a.analysis.static.hysteresis.value / a.truth.B - 1) for a in found])
    show("T, gradient descent alone", [abs(a.analysis.dynamics.gradient_T / a.truth.T - 1) for a in found])
    show("T, least squares alone", [abs(a.analysis.dynamics.T.value / a.truth.T - 1) for a in found])
    for by_steps in (False, True):
        for amplitude in (2.0, 10.0, 50.0):
            worst = [max(a.position_error(amplitude, f, by_steps) for f in reference.FREQUENCIES) for a in found]
            show(f"position at {amplitude:g} %{', step by step' if by_steps else ''}", worst)


def show(name: str, errors: list[float]) -> None:
    """A row: median and worst in per cent."""
    print(f"| {name} | {100 * np.median(errors):.2g} % | {100 * max(errors):.2g} % |")


if __name__ == "__main__":
    main(*(int(number) for number in sys.argv[1:] or [50]))

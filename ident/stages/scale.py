"""How a parameter of a machine of unknown size is searched: what it is measured by, and between which ratios."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ident.cached import cached_property
from ident.equations.equation import Equation
from ident.errors import Unusable
from ident.parameter import Parameter

OF_THE_RUNS = frozenset("WXULVMH")
"""What a scale may read of the runs together: W, the angular frequency up to which the command excites the machine
(rad/s), X, U, L and V, the standard deviations of output, command, position and speed, M, the largest command, H, the
longest time for which the command of a run is held after its changes (s)."""
ORDER_OF_MAGNITUDE = "order of magnitude; searched over scale-free ratios"
"""The source of a parameter whose bounds belong to no certain machine."""


@dataclass(frozen=True)
class Scale:
    """The range of a search: value = ratio × `text`, `lower` ≤ ratio ≤ `upper`.

    `text` may read conditions (their typical value over the runs), other parameters, and :data:`OF_THE_RUNS`.
    """

    name: str
    text: str
    lower: float
    upper: float
    logarithmic: bool = True

    @classmethod
    def by_bounds(cls, parameter: Parameter, logarithmic: bool = True) -> Scale:
        """The range of a parameter whose bounds in SI hold for machines of every size."""
        return cls(parameter.in_equations, "1", parameter.lower, parameter.upper, logarithmic)

    @cached_property
    def equation(self) -> Equation:
        """The scale as an equation of the grammar."""
        return Equation(f"{self.name} = {self.text}")

    @cached_property
    def power(self) -> float:
        """n, where the scale goes with Wⁿ: −1 for a time constant, 1 for a rate, 2 for a stiffness over a mass.

        0 for what a signal's size measures: that is no mode's speed alone.
        """
        if self.equation.names & (OF_THE_RUNS - {"W"}):
            return 0.0
        known = dict.fromkeys(self.equation.names, 1.0)
        return float(np.log2(self.equation.value({**known, "W": 2.0}) / self.equation.value(known)))

    def slower_than(self, ratio: float) -> tuple[float, float]:
        """Its bounds where nothing is to go faster than `ratio` times W; one decade is left of them at least.

        A mode that is over within a small part of a sample shows in no record, and no simulation in steps follows it.
        """
        edge = ratio**self.power
        if not self.logarithmic or self.power == 0:
            return self.lower, self.upper
        if self.power < 0:
            return min(max(self.lower, edge), self.upper / 10.0), self.upper
        return self.lower, max(min(self.upper, edge), self.lower * 10.0)


def in_reading_order(scales: Iterable[Scale]) -> tuple[Scale, ...]:
    """Each scale after those whose parameters it reads, and otherwise as they stand.

    Raises Unusable where scales read each other in a circle.
    """
    known = {scale.name: scale for scale in scales}
    placed: dict[str, Scale] = {}

    def place(name: str, readers: tuple[str, ...] = ()) -> None:
        if name in readers:
            circle = " → ".join((*readers[readers.index(name) :], name))
            raise Unusable(
                "circular-scales",
                f"{circle}: each is measured by the next",
                "scales of the parameters",
                "measure one of them by the runs or by a condition",
            )
        for read in known:
            if read in known[name].equation.names and read not in placed:
                place(read, (*readers, name))
        placed[name] = known[name]

    for name in known:
        if name not in placed:
            place(name)
    return tuple(placed.values())

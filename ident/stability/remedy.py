"""What would make a loop stable again: each part alone, by how much, the smallest change first.

The size of a change is |ln factor|, so that twice and half are equally large; a remedy leaves a gain margin of 3 dB.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.stability.first_point import Flags, first_point
from ident.stability.gain_margin import gain_margin, keeps_margin
from ident.stability.loop import CHANGEABLE, SAMPLES, Loop, LoopPart, from_to
from ident.words.number import plain

Array = NDArray[np.float64]
WIDEST = float(np.log(100.0))
"""Of ln factor: a remedy makes a quantity at most 100 times as large or as small."""
ROOM = 1.04
"""Times the size of the smallest change that would do: for what the parameters of the model are off by."""
_ROUNDING = 1e-9  # of a sample
_SCANNED = 47  # sizes, 0.1 apart


@dataclass(frozen=True)
class Remedy:
    """One quantity times `factor`, from `before` to `after` in `unit`; `size` is |ln factor|.

    `gain_margin` is what it leaves, dB; None where nothing up to 60 dB loses stability.
    """

    name: str
    kind: str
    meaning: str
    unit: str
    before: float
    after: float
    factor: float
    size: float
    gain_margin: float | None

    def __str__(self) -> str:
        what = self.kind if self.kind.endswith(self.name) else f"{self.kind} {self.name}"
        return f"{what} × {plain(self.factor, 3)} ({from_to(self.before, self.after, self.unit)})"


def remedies(loop: Loop) -> tuple[Remedy, ...]:
    """What makes the loop stable with a gain margin of 3 dB, each by one quantity alone, the smallest change first."""
    found = [one for part in loop.parts for one in _by(loop, part)]
    return tuple(sorted(found, key=lambda one: one.size))


def _by(loop: Loop, part: LoopPart) -> Iterator[Remedy]:
    """The smallest change of a quantity that does, either way."""
    if part.fixed or not part.value or part.kind not in CHANGEABLE:
        return
    for sign in (-1.0,) if CHANGEABLE[part.kind] else (-1.0, 1.0):
        size = _smallest(loop, part.name, sign)
        if size is not None:
            factor = float(np.exp(sign * size))
            if part.unit == SAMPLES:  # there are only whole ones
                factor = max(1.0, np.floor(factor * part.value + _ROUNDING)) / part.value
            yield Remedy(
                part.name,
                part.kind,
                part.meaning,
                part.unit,
                part.value,
                part.value * factor,
                factor,
                size,
                gain_margin(loop, {part.name: factor}),
            )


def _smallest(loop: Loop, name: str, sign: float) -> float | None:
    """The size of the smallest change in one direction that does, with room; None where there is none."""

    def does(sizes: Array) -> Flags:
        return keeps_margin(loop, name, np.exp(sign * sizes))

    size = first_point(does, np.linspace(0.0, WIDEST, _SCANNED))
    if not size:
        return size
    return ROOM * size if does(np.array([ROOM * size]))[0] else size

"""First states on their way to where they hold: how far to go on from what a record shows of them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ident.fit.normal_matrices import NormalMatrices

Array = NDArray[np.float64]
_ROUNDS = 10  # of each kind of steps
ROUNDS = 2 * _ROUNDS
"""Rounds at most in which the first states of a model are found."""
_DAMPING = 1e-6  # of the first step that is damped


@dataclass(frozen=True)
class Least:
    """The first states (n,) that least is left of a run with, what was found there, and the damping of a step."""

    start: Array
    found: NormalMatrices
    damping: float = _DAMPING


@dataclass
class Settling:
    """The runs that settle, by their ids, with the `least` so far.

    Gauss and Newton's steps often lead to where the model is straight over a place where it is not, and are gone on
    with whatever is left on the way. A run that they lead nowhere goes on from where least is left of it, by steps
    that shrink (Levenberg and Marquardt).
    """

    least: dict[str, Least] = field(default_factory=dict)

    def step(self, run: str, start: Array, found: NormalMatrices, count: int) -> tuple[Array, Array] | None:
        """From which states (n,) a run goes on, and how far along those that are free; None where they hold."""
        back, best = count >= _ROUNDS, self.least.get(run)
        if best is None or found.power < best.found.power:
            best = Least(start, found) if best is None else Least(start, found, best.damping / 10.0)
        elif back:
            best = replace(best, damping=best.damping * 100.0)
        self.least[run] = best
        if best.found.settled:
            return None
        return (best.start, best.found.step(best.damping)) if back else (start, found.release)

"""First states on their way to where they hold: how far to go on from what a record shows of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ident.fit.normal_matrices import NormalMatrices

Array = NDArray[np.float64]
ROUNDS = 20
"""Rounds at most in which the first states of a model are found."""
_DAMPING = 1e-6  # of the first step that is damped
_LESS = 1e-3  # by which the residual has to fall for a round to count
_IN_VAIN = {False: 1, True: 4}  # rounds of one kind of steps that do not, by whether much is promised


@dataclass(frozen=True)
class Least:
    """The first states (n,) with the smallest residual of a run, what was found there, and the damping of a step.

    `vain` rounds have passed since that counted; the steps go `back` to there once straight ones led nowhere.
    """

    start: Array
    found: NormalMatrices
    damping: float = _DAMPING
    vain: int = 0
    back: bool = False


@dataclass
class Settling:
    """The runs that settle, by their ids, with the `least` so far.

    Gauss and Newton's steps often lead to where the model is straight over a place where it is not, so the residual may
    rise on the way. A run on which they fail, though much is promised, goes on from its smallest residual, by steps
    that shrink (Levenberg and Marquardt).
    """

    least: dict[str, Least] = field(default_factory=dict)

    def step(self, run: str, start: Array, found: NormalMatrices) -> tuple[Array, Array] | None:
        """From which states (n,) a run goes on, and how far along those that are free; None where they hold."""
        best = self.least.get(run) or Least(start, found)
        vain = 0 if found.power < (1.0 - _LESS) * best.found.power else best.vain + 1
        if found.power < best.found.power:
            best = replace(best, start=start, found=found, vain=vain, damping=best.damping / 10.0)
        else:
            best = replace(best, vain=vain, damping=best.damping * (100.0 if best.back else 1.0))
        over = best.found.settled or best.vain > _IN_VAIN[best.found.promises]
        if over and not best.back and best.found.promises:
            best, over = replace(best, vain=0, back=True, damping=_DAMPING), False
        self.least[run] = best
        if over:
            return None
        return (best.start, best.found.step(best.damping)) if best.back else (start, found.release)


def better(ends: Sequence[Least]) -> Least:
    """Of the ends of several guesses that with the smallest residual of a run; of those as good, that with less offset.

    In saturation a position that is shifted changes nothing else.
    """
    least = min(end.found.power for end in ends)
    as_good = [end for end in ends if end.found.power <= least + _LESS * abs(least)]
    return min(as_good, key=lambda end: abs(end.found.offset))

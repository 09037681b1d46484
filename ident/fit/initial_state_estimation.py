"""Estimation of the initial states of runs: full steps of Gauss and Newton, damped ones where these stall."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ident.fit.criteria import FIT_CRITERIA
from ident.fit.normal_matrices import NormalMatrices

Array = NDArray[np.float64]
_OF = FIT_CRITERIA.first_states


@dataclass(frozen=True)
class BestInitialState:
    """The first states (n,) with the smallest residual of a run, what was found there, and the damping of a step.

    `stalled_rounds` have passed since it became smaller. The steps are `damped` and begin at these states once full
    steps led nowhere.
    """

    start: Array
    found: NormalMatrices
    damping: float = _OF.damping
    stalled_rounds: int = 0
    damped: bool = False


@dataclass
class InitialStateEstimation:
    """The runs that settle, by their ids, with the `least` so far.

    Gauss and Newton's steps often lead to where the model is straight over a place where it is not, so the residual may
    rise on the way. A run on which they fail, though much is promised, goes on from its smallest residual, by steps
    that shrink (Levenberg and Marquardt).
    """

    least: dict[str, BestInitialState] = field(default_factory=dict)

    def step(self, run: str, start: Array, found: NormalMatrices) -> tuple[Array, Array] | None:
        """From which states (n,) a run goes on, and how far along those that are free; None where they hold."""
        best = self.least.get(run) or BestInitialState(start, found)
        stalled_rounds = 0 if found.power < (1.0 - _OF.helps) * best.found.power else best.stalled_rounds + 1
        if found.power < best.found.power:
            best = replace(
                best, start=start, found=found, stalled_rounds=stalled_rounds, damping=best.damping / _OF.less
            )
        else:
            best = replace(
                best, stalled_rounds=stalled_rounds, damping=best.damping * (_OF.more if best.damped else 1.0)
            )
        over = best.found.settled or best.stalled_rounds > (_OF.in_vain_of_much if best.found.promises else _OF.in_vain)
        if over and not best.damped and best.found.promises:
            best, over = replace(best, stalled_rounds=0, damped=True, damping=_OF.damping), False
        self.least[run] = best
        if over:
            return None
        return (best.start, best.found.step(best.damping)) if best.damped else (start, found.release)


def better(ends: Sequence[BestInitialState]) -> BestInitialState:
    """Of the ends of several guesses that with the smallest residual of a run; of those as good, that with less offset.

    In saturation a position that is shifted changes nothing else.
    """
    least = min(end.found.power for end in ends)
    as_good = [end for end in ends if end.found.power <= least + _OF.helps * abs(least)]
    return min(as_good, key=lambda end: abs(end.found.offset))

"""Least squares from the best members of a search and from what the procedures found: where they end, and what it says.

The sum of squares is not smooth where the play turns: each start ends in a fold of its own, a part of a standard error
from the others. Ends that differ by no more than that are one optimum, and the fit is then the end that hangs on no
search.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.least_squares import Solution, solve
from ident.bench.model import Model
from ident.bench.reduced_record import Observed
from ident.bench.residual import Residual
from ident.fit.criteria import FIT_CRITERIA
from ident.fit.local_optima import LocalOptimum, disagreements

_OF = BENCH_CRITERIA.fits
_ASTRAY = "No member of the search leads as near to the records as the procedures: the fit starts from their values."


def polished(
    searched: Sequence[Model], own: Model | None, observed: tuple[Observed, ...], names: tuple[str, ...]
) -> tuple[Solution, list[str]]:
    """The best end, and what is to be said of the others; `own` is the procedures' model, where the bounds allow it."""
    starts = [*([] if own is None else [own]), *searched]
    found = [solve(Residual(start, observed, names), steps=_OF.polish if names else 0) for start in starts]
    least = min(solution.cost for solution in found)
    best = next(solution for solution in found if solution.cost <= (1 + _OF.folds) * least)
    others = [_end(solution) for solution in found if solution.cost > (1 + _OF.folds) * least]
    sure = {name: best.deviations[name] for name in names if name not in weak(best)}
    told = list(disagreements([_end(best), *others], sure, {name: name for name in sure}))
    astray = (
        own is not None and min(_end(solution).error for solution in found[1:]) > _OF.farther * _end(found[0]).error
    )
    return best, [_ASTRAY, *told] if astray else told


def weak(solution: Solution) -> list[str]:
    """The values that the records do not determine."""
    size = {name: solution.residual.reach.get(name, abs(value)) for name, value in solution.values.items()}
    return [
        name
        for name, deviation in solution.deviations.items()
        if not 0 < deviation < FIT_CRITERIA.determination.determined * size[name]
    ]


def _end(solution: Solution) -> LocalOptimum:
    return LocalOptimum(float(np.sqrt(solution.cost)), solution.values, solution.point)

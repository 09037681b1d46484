"""Local optima that a search ends at: its distinct starts, optima of the same error, and those that compete."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.fit.criteria import FIT_CRITERIA
from ident.words.percent import PER_CENT

Array = NDArray[np.float64]
_OF = FIT_CRITERIA.optima


@dataclass(frozen=True)
class LocalOptimum:
    """Where the polish of one start ended: the error, the values by name, the point of the search space."""

    error: float
    values: Mapping[str, float]
    point: Array


def distinct(points: Iterable[Array], most: int) -> list[Array]:
    """The first points that are at least a tenth of an axis apart, at most so many."""
    chosen: list[Array] = []
    for point in points:
        if all(np.abs(point - other).max() > FIT_CRITERIA.search.apart for other in chosen):
            chosen.append(point)
        if len(chosen) == most:
            break
    return chosen


def equivalent_points(ends: Sequence[LocalOptimum]) -> list[Array]:
    """The points of the optima that have the error of the first: the data do not determine what differs among them."""
    return [end.point for end in ends if end.error <= ends[0].error * (1 + _OF.same)]


def agreeing(ends: Sequence[LocalOptimum], best: LocalOptimum) -> int:
    """How many ends have the error of the best."""
    return sum(bool(end.error <= best.error * (1 + _OF.agree)) for end in ends)


def at_bound(end: LocalOptimum) -> bool:
    """Whether an axis ended at its bound."""
    return bool(np.any((end.point < _OF.edge) | (end.point > 1 - _OF.edge)))


def competing_optima(ends: Sequence[LocalOptimum]) -> list[LocalOptimum]:
    """The optima whose error is nearly that of the first, but not the same."""
    return [end for end in ends if ends[0].error * (1 + _OF.same) < end.error <= ends[0].error * (1 + _OF.near)]


def disagreements(
    ends: Sequence[LocalOptimum], deviations: Mapping[str, float], label: Mapping[str, str]
) -> Iterator[str]:
    """In words, where other starts ended within 1 % of the first one's error, but a standard error or more from it.

    `deviations` holds the standard errors of what is determined, `label` how each is called. Ends of the same error
    are a valley, and part of the standard errors.
    """
    near = competing_optima(ends)
    far = {
        name: max(abs(end.values[name] - ends[0].values[name]) for end in near) / deviation
        for name, deviation in deviations.items()
        if near and deviation > 0
    }
    told = [f"{label[name]} by {far[name]:.2g}" for name in sorted(far, key=lambda name: -far[name]) if far[name] > 1]
    if told:
        excess = PER_CENT * (max(end.error for end in near) / ends[0].error - 1)
        yield (
            f"Other members of the search end elsewhere with an error at most {excess:.2g} % larger; in standard "
            f"errors they differ from this fit: {', '.join(told)}."
        )

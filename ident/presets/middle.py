"""The middle of the stroke: of the way that a machine which integrates its command was seen to cover."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ident.chain.chain import Chain, integrates
from ident.effects.effect import Effect
from ident.matrix import Matrix

MIDDLE = "middle"
"""The shape of an effect that it acts to both sides of."""


def middle_of(matrix: Matrix, chain: Chain) -> float:
    """The middle of the displacements of the runs to fit, m; 0 where they cover the zero of the transducer.

    A machine that is held in a loop has its zero where that is set. A cylinder in open loop goes to its ends, and the
    transducer counts from wherever it was mounted.
    """
    moved = [run.channels["displacement"] for run in matrix.of_use("fit") if "displacement" in run.channels]
    if not moved or not integrates(chain, matrix.runs, matrix.actuator):
        return 0.0
    low, high = min(map(np.min, moved)), max(map(np.max, moved))
    return 0.0 if low <= 0.0 <= high else float(low + high) / 2.0


def about(effect: Effect, middle: float) -> Effect:
    """The effect with its middle there, where it has one that nobody stated."""
    if effect.own or not middle:
        return effect
    reach = 2.0 * abs(middle)
    shape = tuple(
        replace(one, value=middle, lower=min(one.lower, -reach), upper=max(one.upper, reach))
        if one.name == MIDDLE
        else one
        for one in effect.shape
    )
    return replace(effect, shape=shape)

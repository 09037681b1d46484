"""Where a machine that begins in motion is guessed to begin, in addition to what its linear model says."""

from __future__ import annotations

from collections.abc import Sequence
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ident.run import Run
from ident.simulation.inputs import closed

Array = NDArray[np.float64]
_known: WeakKeyDictionary[Run, float] = WeakKeyDictionary()
"""Of each run its first position: each refit asks for the same ones."""


def first_position(run: Run) -> float:
    """The position in which a run begins whose motion was given by its speed: its way goes as far to either side."""
    known = _known.get(run)
    if known is None:
        known = _known[run] = begins_about_middle(run.channels["velocity"]) / run.sample_rate
    return known


def begins_about_middle(speed: Array) -> float:
    """Where a motion of a speed (n,) per sample begins, whose way goes as far to either side."""
    covered = 0.5 * (speed[1:] + speed[:-1]) + closed(speed)[:-1]
    way = np.append(0.0, np.cumsum(covered))
    return float(-0.5 * (way.max() + way.min()))


def with_followers(start: Array, A: Array, own: Sequence[int], core: Sequence[int]) -> Array:
    """Guesses (1, g, n) and, behind them, the same with states of effects where they have followed the core.

    A mass behind a spring moves along with the drive: where small signals z' = A z hold, the states of the effects, at
    the places `own`, are z_e = −A_ee⁺ A_ec z_c of those of the `core`. None is added where they have nothing to follow.
    """
    follows = -np.linalg.pinv(A[np.ix_(own, own)]) @ A[np.ix_(own, core)]
    if not np.all(np.isfinite(follows)) or not follows.any():
        return start
    along = start.copy()
    along[..., own] = along[..., core] @ follows.T
    return np.concatenate([start, along], axis=1)


def in_order(power: Array) -> NDArray[np.intp]:
    """The numbers of guesses by the power (g,) of what each leaves of a record, the least first."""
    return np.argsort(np.where(np.isfinite(power), power, np.inf), kind="stable")


def order_stays(power: Array, outputs: Array, rest: Array) -> bool:
    """Whether the `rest` (m,) of a record cannot change the order of guesses: their outputs have come together.

    `power` (g,) is that of their residuals r so far, `outputs` (n, g) are the last ones. Two that lie within δ of each
    other from there on change the difference of their powers by Σ |δ (r + r')| ≤ 2 δ √m |r| + δ² m at most, and a
    residual is taken to have at most twice the size of the record.
    """
    order = in_order(power)
    gaps, ran_away = np.diff(power[order]), ~np.isfinite(power[order[:-1]])  # it leaves no less, nor does the next
    apart = np.abs(np.diff(outputs[:, order], axis=1)).max(axis=0)
    residual = 2.0 * np.linalg.norm(rest)
    changes = 2.0 * apart * np.sqrt(len(rest)) * residual + apart**2 * len(rest)
    return bool(np.all((gaps >= changes) | ran_away))

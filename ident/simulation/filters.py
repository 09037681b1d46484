"""The gains with which a kernel advances `lag`, `lag2` and `delay` of its equations, exactly over a step."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from math import factorial

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ident.chain.chain import STEP
from ident.simulation.kernel import Filter, constant

Array = NDArray[np.float64]
_TERMS = 18  # of a series in a ≤ 1
_SERIES = [
    np.array([[(-1) ** k * factorial(m) / factorial(m + k + 1)] for m in (1, 2)]) for k in reversed(range(_TERMS))
]


def pack_filter(rows: Array, known: Filter, values: Mapping[str, Array]) -> None:
    """Put the gains of a filter into its rows of a buffer (rows, lanes), a row for each state and moment of a step.

    They are those of its states at the start of the step and then of its input: at the start of the input there; over
    half a step of the input at both ends, for one that is a line; over the whole of the input at the start, the middle
    and the end, for a parabola. A filter without any time constant passes its input on. A value before the step is not
    asked for: the command may have jumped.
    """
    given = (*(constant(node, values) for node in known.coefficients), values[STEP])
    lanes = [np.broadcast_to(value, rows.shape[1:]) for value in given]
    gains = (_of_first_order if known.order == 1 else _of_second_order)(*lanes)
    first = known.first + known.order
    rows[first : first + len(gains)] = gains


def _of_first_order(T: Array, step: Array) -> Array:
    """The gains of T x' = u − x, (9, lanes)."""
    start = [np.where(T > 0, 1.0, 0.0), np.where(T > 0, 0.0, 1.0)]
    phi, of_constant, of_ramp, _ = _of_lag(T, step / 2)
    half = [phi, of_constant - of_ramp, of_ramp]
    phi, *responses = _of_lag(T, step)
    return np.array([*start, *half, phi, *_through_three(*responses)])


def _of_lag(T: Array, duration: Array) -> tuple[Array, Array, Array, Array]:
    """What a lag has left of its state after a duration, and its responses to the inputs 1, σ and σ², σ = t/duration.

    With a = duration/T they are e⁻ᵃ and ∫ a e^(−a (1 − σ)) σᵐ dσ = m! Σ (−1)ᵏ aᵏ⁺¹/(m + k + 1)!, by parts from a = 1.
    """
    with np.errstate(divide="ignore"):
        a = duration / np.maximum(T, 0.0)
    short, series = np.minimum(a, 1.0), np.zeros((2, *a.shape))
    for terms in _SERIES:
        series = (series + terms) * short
    of_ramp, of_parabola = series
    of_constant, long = -np.expm1(-a), np.maximum(a, 1.0)
    ramp = np.where(a > 1.0, 1.0 - of_constant / long, of_ramp)
    return np.exp(-a), of_constant, ramp, np.where(a > 1.0, 1.0 - 2.0 * ramp / long, of_parabola)


def _through_three(of_constant: Array, of_ramp: Array, of_parabola: Array) -> tuple[Array, Array, Array]:
    """The gains of values x0, xm, x1 at σ = 0, ½, 1: x = x0 + (−3 x0 + 4 xm − x1) σ + (2 x0 − 4 xm + 2 x1) σ²."""
    return of_constant - 3 * of_ramp + 2 * of_parabola, 4 * of_ramp - 4 * of_parabola, 2 * of_parabola - of_ramp


def _of_second_order(a1: Array, a2: Array, step: Array) -> Array:
    """The gains of a2 x'' + a1 x' + x = u, (24, lanes)."""
    entries = np.column_stack([a1, a2, step])
    cases, of_lane = np.unique(entries, axis=0, return_inverse=True)
    return np.array([_gains(*case) for case in cases.tolist()])[of_lane.ravel()].T


@lru_cache(4096)
def _gains(a1: float, a2: float, step: float) -> Array:
    """The gains of one filter of second order, flat."""
    start, half, whole = (np.zeros((2, 2 + inputs)) for inputs in (1, 2, 3))
    if a1 <= 0 and a2 <= 0:
        start[0, -1] = half[0, -1] = whole[0, -1] = 1.0
        return np.concatenate([start.ravel(), half.ravel(), whole.ravel()])
    start[:, :2] = np.eye(2)
    phi, of_constant, of_ramp, _ = _responses(a1, a2, step / 2)
    half[:, :2], half[:, 2], half[:, 3] = phi, of_constant - of_ramp, of_ramp
    phi, *responses = _responses(a1, a2, step)
    whole[:, :2], whole[:, 2:] = phi, np.column_stack(_through_three(*responses))
    return np.concatenate([start.ravel(), half.ravel(), whole.ravel()])


def _responses(a1: float, a2: float, duration: float) -> tuple[Array, Array, Array, Array]:
    """Transition matrix over `duration`, and the states' responses to the inputs 1, σ and σ², σ = t/duration."""
    a2 = max(a2, (1e-3 * duration) ** 2)
    augmented = np.zeros((5, 5))
    augmented[:2, :2] = [[0.0, duration], [-duration / a2, -duration * a1 / a2]]
    augmented[1, 2] = duration / a2
    augmented[2, 3] = augmented[3, 4] = 1.0
    scale = np.array([1.0, duration, 1.0, 1.0, 1.0])  # the second state is a rate: in units of the duration
    phi = scipy.linalg.expm(augmented * scale[:, None] / scale) / scale[:, None] * scale
    return phi[:2, :2], phi[:2, 2], phi[:2, 3], 2.0 * phi[:2, 4]

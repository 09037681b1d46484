"""The states in which a chain stands while its command is held: where a run begins that stands still away from zero."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import Chain

Array = NDArray[np.float64]
_STEPS, _GROWS = 20, 10.0  # of pseudo time, each so many times the one before
_FIRST = 1e-3  # of a sample, the first of them
_STEP, _SHARE = 1e-9, 1e-7  # of a unit, and of what stands there: a difference
_STANDS, _NOTHING = 1e-10, 1e-15  # change in a step, relative and in a state's unit


def equilibrium(
    chain: Chain, output: str, values: Mapping[str, Array], u: Array, sample_rate: float, near: Array
) -> Array:
    """States z (runs, v, n) with f(z, u) = 0 under commands held at u (runs, 1), reached from those `near`.

    `values` maps every symbol of the chain to what broadcasts to (runs, v). Implicit steps of a time δ that grows,
    z ← z + (1/δ − ∂f/∂z)⁻¹ f (pseudo-transient continuation; Kelley and Keyes 1998), go where the machine itself would
    settle: in a dead zone, where nothing says which of many standstills it is, to the nearest. What does not settle
    begins at `near`.
    """
    evaluate, n = chain.evaluator(output), len(chain.states)
    shape = np.broadcast_shapes((len(u), 1), *(np.shape(value) for value in values.values()))
    first = np.broadcast_to(near, (*shape, n))
    z, delta = first.copy(), _FIRST / sample_rate
    with np.errstate(all="ignore"):
        for _ in range(_STEPS):
            steps = np.maximum(_STEP, _SHARE * np.abs(z))
            tried = np.repeat(np.moveaxis(z, -1, 0)[:, None], n + 1, axis=1)  # (states, as it is and each one moved, …)
            tried[np.arange(n), np.arange(n) + 1] += np.moveaxis(steps, -1, 0)
            rates = np.stack([np.broadcast_to(rate, tried.shape[1:]) for rate in evaluate(u, tuple(tried), values)[0]])
            here = np.moveaxis(rates[:, 0], 0, -1)
            slopes = np.moveaxis((rates[:, 1:] - rates[:, :1]), (0, 1), (-2, -1)) / steps[..., None, :]
            idle = np.all(slopes == 0, axis=tuple(range(slopes.ndim - 1)))  # it drives nothing: it may be anywhere
            here[..., idle], slopes[..., idle, :] = 0.0, 0.0
            system = np.eye(n) / delta - slopes
            finite = np.isfinite(system).all(axis=(-1, -2)) & np.isfinite(here).all(axis=-1)
            sound = np.asarray(finite)[..., None]
            system = np.where(sound[..., None], system, np.eye(n))
            change = np.linalg.solve(system, np.where(sound, here, np.nan)[..., None])[..., 0]
            z = z + change
            if not np.any(np.abs(change) > _STANDS * np.abs(z) + _NOTHING):
                break
            delta *= _GROWS
    return np.where(np.isfinite(z).all(axis=-1, keepdims=True), z, first)

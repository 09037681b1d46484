"""Runs on a coarse clock: fast enough for the band that the command excites, and small.

Records are averaged over a whole number of samples. Averaging and a linear response commute, so that what is averaged
on both sides of an equation still obeys it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ident.fit.reduction import excited_band
from ident.fit.trial_runs import band_stride
from ident.linear import LinearModel
from ident.run import Run
from ident.simulation.jit import jit
from ident.simulation.recursion import discretise

Array = NDArray[np.float64]
_OVER = 8.0  # samples a period of the band edge


def stride(runs: Sequence[Run]) -> int:
    """Samples that are averaged into one."""
    return band_stride(runs, excited_band(runs), _OVER)


def averaged(samples: Array, count: int) -> Array:
    """Means of `count` samples each, (n,) → (n // count,)."""
    whole = len(samples) // count * count
    return np.asarray(samples[:whole].reshape(-1, count).mean(axis=1))


@dataclass(frozen=True)
class Response:
    """Linear models with common A and B in discrete time, their inputs joined by lines: Φ, Γ0, Γ1, C (m, n), D (m).

    The states are in units of `scale`, (n,): in SI they differ by ten decades, which would cost time and digits.
    """

    phi: Array
    gamma0: Array
    gamma1: Array
    C: Array
    D: Array
    scale: Array

    @classmethod
    def of(cls, models: Sequence[LinearModel], rate: float) -> Response:
        """The models, each a batch of one, at `rate` Hz."""
        A, B = models[0].A[0], models[0].B[0]
        _, (scale, _) = scipy.linalg.matrix_balance(A, permute=False, separate=True)
        B = B / scale
        size = np.abs(B).max() or 1.0
        scale, B = scale * size, B / size
        C = np.array([model.C for model in models])[:, 0] * scale
        D = np.array([model.D[0] for model in models])
        scaled = LinearModel.of((A * scale / scale[:, None])[None], B[None], C[:1], D[:1])
        known = discretise(scaled, rate, "linear")
        return cls(np.ascontiguousarray(known.phi[0]), known.gamma[0, 0], known.gamma[0, 1], C, D, scale)

    def only(self, count: int) -> Response:
        """The first `count` of the models."""
        return replace(self, C=self.C[:count], D=self.D[:count])

    def to(self, inputs: Array, start: Array | None = None) -> Array:
        """The outputs (samples, b, m) for inputs (samples, b); `start` is the state at the first sample, (n,)."""
        first = np.zeros(len(self.scale)) if start is None else start / self.scale
        # Lines between samples lose 1 − sinc² of a sine, a share of (π f/fs)²/3: a twelfth of the second difference.
        rows = np.array(inputs)
        rows[1:-1] -= (inputs[2:] - 2 * inputs[1:-1] + inputs[:-2]) / 12
        return np.asarray(_respond(self.phi, self.gamma0, self.gamma1, self.C, self.D, first, rows))


@jit(nogil=True, fastmath={"contract"})
def _respond(phi: Array, gamma0: Array, gamma1: Array, C: Array, D: Array, first: Array, inputs: Array) -> Array:
    samples, width = inputs.shape
    n, m = len(first), len(D)
    out = np.zeros((samples, width, m))
    state, following = np.zeros((n, width)), np.zeros((n, width))
    for i in range(n):
        for b in range(width):
            state[i, b] = first[i]
    for k in range(samples):
        for j in range(m):
            for b in range(width):
                out[k, b, j] = D[j] * inputs[k, b]
            for i in range(n):
                c = C[j, i]
                for b in range(width):
                    out[k, b, j] += c * state[i, b]
        if k + 1 < samples:
            for i in range(n):
                for b in range(width):
                    following[i, b] = gamma0[i] * inputs[k, b] + gamma1[i] * inputs[k + 1, b]
                for j in range(n):
                    p = phi[i, j]
                    for b in range(width):
                        following[i, b] += p * state[j, b]
            state, following = following, state
    return out

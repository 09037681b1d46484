"""A linear model in state space, for a batch of parameter vectors and runs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class LinearModel:
    """ẋ = A x + B u, y = C x + D u for a batch of parameter vectors and runs.

    `system` is [[A, B], [C, D]], shape (n + 1, n + 1, ...), the batch last: one coefficient of the whole batch lies
    together in memory. A (..., n, n), B (..., n), C (..., n) and D (...) are views of it.
    """

    system: Array

    @classmethod
    def of(cls, A: Array, B: Array, C: Array, D: Array) -> LinearModel:
        """From batches of matrices of the shapes above."""
        top = np.concatenate([A, B[..., None]], axis=-1)
        bottom = np.concatenate([C, D[..., None]], axis=-1)[..., None, :]
        return cls(np.moveaxis(np.concatenate([top, bottom], axis=-2), (-2, -1), (0, 1)))

    @property
    def A(self) -> Array:
        """System matrix (..., n, n)."""
        return np.moveaxis(self.system[:-1, :-1], (0, 1), (-2, -1))

    @property
    def B(self) -> Array:
        """Input vector (..., n)."""
        return np.moveaxis(self.system[:-1, -1], 0, -1)

    @property
    def C(self) -> Array:
        """Output vector (..., n)."""
        return np.moveaxis(self.system[-1, :-1], 0, -1)

    @property
    def D(self) -> Array:
        """Feed-through (...)."""
        return np.asarray(self.system[-1, -1])

    def of_states(self, states: tuple[int, ...]) -> LinearModel:
        """The model of some states alone, by their places: of those that the output depends on it is the same."""
        last = len(self.system) - 1
        if len(states) == last:
            return self
        return LinearModel(self.system[np.ix_((*states, last), (*states, last))])

    def standing(self, u: Array | float, y: Array | float) -> Array:
        """The states (..., n) that stand under a command held at u: 0 = A z + B u.

        What integrates and drives nothing, a position that no spring and no loop holds, may be anywhere: it is where
        the output is y. Zero where nothing stands.
        """
        A, B, C = self.A, self.B, self.C
        idle = np.all(A == 0, axis=tuple(range(A.ndim - 1)))
        # One machine may be held at many commands: its matrices are then of fewer points than these.
        points = np.broadcast_shapes(B.shape[:-1], np.shape(u), np.shape(y))
        z, kept = np.zeros((*points, B.shape[-1])), np.flatnonzero(~idle)
        with np.errstate(all="ignore"):
            drive = -B[..., kept, None] * np.asarray(u)[..., None, None]
            driving = A[..., kept[:, None], kept]
            try:
                z[..., kept] = np.linalg.solve(driving, drive)[..., 0]
            except np.linalg.LinAlgError:  # one of them is singular, for which all are refused
                singular = np.linalg.slogdet(driving).sign == 0
                driving = np.where(singular[..., None, None], np.nan, driving)
                z[..., kept] = np.linalg.solve(driving, drive)[..., 0]
        z = np.where(np.isfinite(z), z, 0.0)
        left, shown = np.asarray(y) - (C * z).sum(axis=-1) - self.D * u, np.broadcast_to(C, z.shape)[..., idle]
        z[..., idle] = np.divide(left[..., None], shown, out=np.zeros(shown.shape), where=shown != 0)
        return z

    def standing_at(self, y: float) -> Array:
        """The states (..., n) that stand with an output of y, under the command that holds it there."""
        per_command = (self.C * self.standing(1.0, 0.0)).sum(axis=-1) + self.D
        u = np.divide(y, per_command, out=np.zeros(per_command.shape), where=np.abs(per_command) > 1e-12)
        return self.standing(u, y)

    def sizes(self, omega: float) -> Array:
        """How large the states are per input at an angular frequency (rad/s), |(jωI − A)⁻¹ B|, (..., n)."""
        at = 1j * omega * np.eye(self.A.shape[-1]) - self.A
        return np.asarray(np.abs(np.linalg.solve(at, self.B[..., None])[..., 0]))

    def frequency_response(self, frequency: Array) -> NDArray[np.complex128]:
        """G(jω) = C (jωI − A)⁻¹ B + D at `frequency` in Hz, shape (f,) → (..., f).

        The states are scaled first: in SI they differ by ten decades, which would cost digits in the solution.
        """
        s = 2j * np.pi * np.asarray(frequency)
        A, B, C = self.A, self.B, self.C
        scale = self.sizes(float(np.abs(s).max()))
        scale = np.where(scale > 0, scale, 1.0)
        A, B, C = A * scale[..., None, :] / scale[..., :, None], B / scale, C * scale
        resolvent = s[:, None, None] * np.eye(A.shape[-1]) - A[..., None, :, :]
        states = np.linalg.solve(resolvent, np.broadcast_to(B[..., None, :, None], (*resolvent.shape[:-1], 1)))[..., 0]
        response: NDArray[np.complex128] = np.einsum("...fn,...n->...f", states, C) + self.D[..., None]
        return response

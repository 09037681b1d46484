"""Small linear systems as matrices: put behind each other, sampled, evaluated; continuous or sampled alike.

A controller and an exported linear part are such systems. :class:`ident.linear.LinearModel` is the batch of plants that
a fit evaluates, :class:`ident.hybrid.rational.Rational` a transfer function that is to be inverted without rounding.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ident.linear import LinearModel

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class StateSpace:
    """x' = A x + B u, y = C x + D u, or the same for x(k+1): A (n, n), B (n, m), C (p, n), D (p, m)."""

    A: Array
    B: Array
    C: Array
    D: Array

    @property
    def order(self) -> int:
        """The number of states."""
        return len(self.A)

    def response(self, at: Complex) -> Complex:
        """C (λI − A)⁻¹ B + D at the points λ (f,), s or z, shape (f, p, m)."""
        resolvent: Complex = at[:, None, None] * np.eye(self.order) - self.A
        inside = np.linalg.solve(resolvent, np.broadcast_to(self.B, (len(at), *self.B.shape)))
        return np.asarray(self.C.astype(complex) @ inside + self.D, complex)

    def before(self, other: StateSpace) -> StateSpace:
        """The two in series, this one first."""
        corner = np.zeros((self.order, other.order))
        return StateSpace(
            np.block([[self.A, corner], [other.B @ self.C, other.A]]),
            np.vstack([self.B, other.B @ self.D]),
            np.hstack([other.D @ self.C, other.C]),
            other.D @ self.D,
        )

    def bilinear(self, sample_rate: float) -> StateSpace:
        """The continuous system sampled by Tustin's rule, s = 2 f (z − 1)/(z + 1)."""
        c = 2.0 * sample_rate
        inverse = np.linalg.inv(c * np.eye(self.order) - self.A)
        return StateSpace(
            inverse @ (c * np.eye(self.order) + self.A),
            2.0 * c * inverse @ self.B,
            self.C @ inverse,
            self.D + self.C @ inverse @ self.B,
        )

    def spectral_radius(self) -> float:
        """The largest magnitude of an eigenvalue of A; a sampled system is stable below 1."""
        return float(np.abs(np.linalg.eigvals(self.A)).max(initial=0.0))


def sampled_plant(plant: LinearModel, sample_rate: float, delay: float) -> StateSpace:
    """A plant between a held command that acts `delay` samples late and samples of its output.

    Exact for any delay τ ≥ 0: of the whole samples in it each is a state, the rest divides the hold,
    x(k+1) = e^{AT} x + e^{A(T−τ)} ∫₀^τ e^{At}dt B u(k−1) + ∫₀^{T−τ} e^{At}dt B u(k), with τ that rest (Åström and
    Wittenmark, Computer-Controlled Systems, section 2.6). `plant` has no batch.
    """
    whole, rest = int(delay), (delay - int(delay)) / sample_rate
    A, B = plant.A, plant.B[:, None]
    late, _ = _held(A, B, rest)
    step, now = _held(A, B, 1.0 / sample_rate - rest)
    _, before = _held(A, B, rest)
    n, line = len(A), whole + (rest > 0)
    system = np.zeros((n + line, n + line))
    system[:n, :n] = step @ late
    drive = np.zeros((n + line, 1))
    inputs = [*(system[:, n + i] for i in range(line)), drive[:, 0]]  # the oldest command first, then the new one
    for i in range(line):
        inputs[i + 1][n + i] = 1.0
    inputs[line - whole][:n] += now[:, 0]
    if rest > 0:
        inputs[0][:n] += (step @ before)[:, 0]
    shown = np.concatenate([plant.C, np.zeros(line)])[None, :]
    through = np.zeros((1, 1)) if line else np.array([[float(plant.D)]])
    return StateSpace(system, drive, shown, through)


def _held(A: Array, B: Array, time: float) -> tuple[Array, Array]:
    """e^{A t} and ∫₀ᵗ e^{A σ} dσ B."""
    n = len(A)
    block = np.zeros((n + 1, n + 1))
    block[:n, :n], block[:n, n:] = A, B
    full = scipy.linalg.expm(block * time)
    return full[:n, :n], full[:n, n:]

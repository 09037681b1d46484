"""Transfer functions as zeros, poles and a gain: exact to invert, to multiply and to sample."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.hybrid.state_space import StateSpace
from ident.linear import LinearModel

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
_VANISHES = 1e-9  # of what the absolute values would make it: a Markov parameter that is rounding only


@dataclass(frozen=True)
class Rational:
    """gain · Π (λ − zero) / Π (λ − pole), with λ = s or z; complex zeros and poles stand with their conjugates."""

    zeros: Complex
    poles: Complex
    gain: float

    @classmethod
    def of_polynomials(cls, numerator: Array, denominator: Array) -> Rational:
        """From coefficients in falling powers."""
        gain = float(np.trim_zeros(numerator, "f")[0] / np.trim_zeros(denominator, "f")[0])
        return cls(np.roots(numerator).astype(complex), np.roots(denominator).astype(complex), gain)

    @classmethod
    def of_model(cls, model: LinearModel) -> Rational:
        """Of a model without a batch. Raises Unusable where nothing of the command arrives at the output."""
        A, B, C = _balanced(model)
        poles = np.linalg.eigvals(A).astype(complex)
        degree, gain = _leading(A, B, C, float(model.D))
        count = len(A) - degree
        pencil = np.block([[A, B[:, None]], [C[None, :], np.array([[float(model.D)]])]])
        mass = np.diag([*np.ones(len(A)), 0.0])
        alpha, beta = scipy.linalg.eigvals(pencil, mass, homogeneous_eigvals=True)
        finite = np.argsort(np.abs(alpha) / np.maximum(np.abs(beta), 1e-300))[:count]
        return cls(np.asarray(alpha[finite] / beta[finite], dtype=complex), poles, gain)

    @property
    def relative_degree(self) -> int:
        """By how much it has more poles than zeros."""
        return len(self.poles) - len(self.zeros)

    @property
    def static_gain(self) -> float:
        """Its value at s = 0."""
        return float((self.gain * np.prod(-self.zeros) / np.prod(-self.poles)).real)

    def response(self, at: Complex) -> Complex:
        """Its values at the points `at` (f,)."""
        found = np.full(len(at), complex(self.gain))
        for i in range(max(len(self.zeros), len(self.poles))):  # in turn, so that no product overflows
            found *= at - self.zeros[i] if i < len(self.zeros) else 1.0
            found /= at - self.poles[i] if i < len(self.poles) else 1.0
        return found

    def times(self, other: Rational) -> Rational:
        """The product."""
        zeros, poles = np.concatenate([self.zeros, other.zeros]), np.concatenate([self.poles, other.poles])
        return Rational(zeros, poles, self.gain * other.gain)

    def inverse(self) -> Rational:
        """One over it."""
        return Rational(self.poles, self.zeros, 1.0 / self.gain)

    def bilinear(self, sample_rate: float) -> Rational:
        """Sampled by Tustin's rule, s = 2 f (z − 1)/(z + 1): what goes to zero at infinity does so at z = −1."""
        c = 2.0 * sample_rate
        gain = float((self.gain * np.prod((c - self.zeros) / c) / np.prod((c - self.poles) / c)).real)
        gain *= c ** (len(self.zeros) - len(self.poles))
        zeros, poles = (c + self.zeros) / (c - self.zeros), (c + self.poles) / (c - self.poles)
        at_infinity = len(poles) - len(zeros)
        zeros = np.concatenate([zeros, np.full(max(at_infinity, 0), -1.0)])
        poles = np.concatenate([poles, np.full(max(-at_infinity, 0), -1.0)])
        return Rational(zeros, poles, gain)

    def realised(self) -> StateSpace:
        """As sections of first and second order behind each other; it must not have more zeros than poles."""
        zeros, poles = _sections(self.zeros), _sections(self.poles)
        each = abs(self.gain) ** (1.0 / max(len(poles), 1))
        system = StateSpace(np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0)), np.array([[np.sign(self.gain)]]))
        if not poles:
            return StateSpace(system.A, system.B, system.C, np.array([[self.gain]]))
        for i, pole in enumerate(poles):
            system = system.before(_section(zeros[i] if i < len(zeros) else (), pole, each))
        return system


def _balanced(model: LinearModel) -> tuple[Array, Array, Array]:
    """State matrices in units of the states that make their numbers alike."""
    full = np.block([[model.A, model.B[:, None]], [model.C[None, :], np.zeros((1, 1))]])
    _, (scale, _) = scipy.linalg.matrix_balance(full, permute=False, separate=True)
    scale = scale / scale[-1]
    inner = scale[:-1]
    return model.A * inner[None, :] / inner[:, None], model.B / inner, model.C * inner


def _leading(A: Array, B: Array, C: Array, D: float) -> tuple[int, float]:
    """The relative degree and the leading coefficient: the first of D, CB, CAB, … that is not zero."""
    if D:
        return 0, D
    state, bound = B, np.abs(B)
    for degree in range(1, len(A) + 1):
        found, largest = float(C @ state), float(np.abs(C) @ bound)
        if abs(found) > _VANISHES * largest:
            return degree, found
        state, bound = A @ state, np.abs(A) @ bound
    raise Unusable("no-answer", "the command does not move the displacement", "fit", "give the fit of an actuator")


def _sections(roots: Complex) -> list[tuple[complex, ...]]:
    """Complex pairs first, then pairs of real roots, at last a single one."""
    upper = sorted((complex(r) for r in roots if r.imag > 0), key=abs)
    real = sorted((complex(r.real) for r in roots if r.imag == 0), key=abs)
    pairs: list[tuple[complex, ...]] = [(r, r.conjugate()) for r in upper]
    pairs += [tuple(real[i : i + 2]) for i in range(0, len(real), 2)]
    return pairs


def _section(zeros: tuple[complex, ...], poles: tuple[complex, ...], gain: float) -> StateSpace:
    """One section in controllable form; of the scale of its own poles, so that sections have numbers alike."""
    denominator = np.real(np.poly(poles))
    numerator = gain * np.real(np.poly(zeros)) if zeros else np.array([gain])
    numerator = np.concatenate([np.zeros(len(poles) + 1 - len(numerator)), numerator])
    through, rest = numerator[0], numerator[1:] - numerator[0] * denominator[1:]
    if len(poles) == 1:
        return StateSpace(np.array([[-denominator[1]]]), np.ones((1, 1)), rest[None, :], np.array([[through]]))
    w = np.sqrt(abs(denominator[2])) or 1.0
    A = np.array([[-denominator[1], -denominator[2] / w], [w, 0.0]])
    return StateSpace(A, np.array([[1.0], [0.0]]), np.array([[rest[0], rest[1] / w]]), np.array([[through]]))

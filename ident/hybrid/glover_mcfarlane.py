"""Robust stabilisation of normalised coprime factors: the largest margin, and the controller that comes near it.

D. McFarlane, K. Glover: A loop shaping design procedure using H∞ synthesis. IEEE Transactions on Automatic Control 37
(1992) 759-769, whose formulae are those of Skogestad and Postlethwaite, Multivariable Feedback Control, section 9.4.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.hybrid.state_space import StateSpace

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Stabilised:
    """The smallest γ, the γ of the controller, and the controller K∞ for negative feedback: u = K∞ (d − y).

    1/γ is the share by which the normalised coprime factors of the shaped plant may change before the loop is lost.
    """

    gamma_min: float
    gamma: float
    controller: StateSpace


def robust_stabilisation(shaped: StateSpace, factor: float) -> Stabilised:
    """K∞ of a strictly proper shaped plant (A, B, C), for γ = `factor` γmin with `factor` > 1.

    With X and Z of AᵀX + XA − XBBᵀX + CᵀC = 0 and AZ + ZAᵀ − ZCᵀCZ + BBᵀ = 0 it is γmin = √(1 + ρ(XZ)), and with
    L = (1 − γ²) I + XZ:  A_K = A − BBᵀX + B_K C,  B_K = γ² L⁻ᵀ Z Cᵀ,  C_K = −BᵀX, all for negative feedback.
    Raises Unusable where the Riccati equations have no solution.
    """
    A, B, C = _alike(shaped)
    try:
        X = scipy.linalg.solve_continuous_are(A, B, C.T @ C, np.eye(B.shape[1]))
        Z = scipy.linalg.solve_continuous_are(A.T, C.T, B @ B.T, np.eye(len(C)))
    except (np.linalg.LinAlgError, ValueError) as error:
        raise Unusable(
            "no-controller",
            f"the Riccati equation has no solution: {error}",
            "target",
            "choose a target of other frequencies",
        ) from None
    gamma_min = float(np.sqrt(1.0 + np.abs(np.linalg.eigvals(X @ Z)).max()))
    gamma = factor * gamma_min
    L = (1.0 - gamma**2) * np.eye(len(A)) + X @ Z
    gain = gamma**2 * np.linalg.solve(L.T, Z @ C.T)
    controller = StateSpace(A - B @ B.T @ X + gain @ C, gain, -B.T @ X, np.zeros((B.shape[1], len(C))))
    return Stabilised(gamma_min, gamma, controller)


def _alike(system: StateSpace) -> tuple[Array, Array, Array]:
    """The matrices in units of the states that make their numbers alike: the Riccati equations are solved better."""
    n = system.order
    corner = np.zeros((system.D.shape[0], system.D.shape[1]))
    full = np.block([[system.A, system.B], [system.C, corner]])
    _, (scale, _) = scipy.linalg.matrix_balance(full, permute=False, separate=True)
    inner, outer = scale[:n], scale[n:]
    A = system.A * inner[None, :] / inner[:, None]
    return A, system.B * outer[: system.B.shape[1]] / inner[:, None], system.C * inner[None, :] / outer[:, None]

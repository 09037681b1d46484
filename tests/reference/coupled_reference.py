"""A hybrid simulation with several actuators in one flat file: an independent judge of the program's loop.

A structure M x'' + C x' + K x = -M i a(t) with displacements x (n,). Actuator p moves its displacement d_p = R_p x;
the specimen has the mass, damping and stiffness Ms, Cs, Ks (P, P) by these displacements. Each actuator is the linear
chain of Qian et al. (2014), eqs. (1)-(7), and all rods move with the specimen together:

    tau q' + q = Kp (u - x)          valve, with the position loop closed
    Ka P' = Z0 q / A - Cl P - A v    oil
    (diag(m0) + Ms) v' = A P - (diag(c0) + Cs) v - Ks x
    f = Ks x + Cs v + Ms v'          load cells between rods and specimen
    (M - R'Ms R) x'' + (C - R'Cs R) x' + (K - R'Ks R) x = -M i a - R' f

At sample j displacements and forces are read, u follows from the wanted d, and is held from sample j + delay on.
Between samples the ground is a straight line, and the forces go on along the line through their last two readings.
Every step is an exact one by a matrix exponential. Nothing in this file comes from the program's library.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
import scipy.linalg
import scipy.optimize
from numpy.typing import NDArray

from tests.reference.hybrid_reference import Actuator, ramps

Array = NDArray[np.float64]


class Loop(NamedTuple):
    """The whole: structure (n, n), direction i (n,), places R (P, n), specimen (P, P), actuators, gains, delays."""

    M: Array
    C: Array
    K: Array
    i: Array
    R: Array
    Ms: Array
    Cs: Array
    Ks: Array
    actuators: tuple[Actuator, ...]
    Kp: tuple[float, ...]
    delays: tuple[int, ...]

    @property
    def numeric(self) -> tuple[Array, Array, Array]:
        """The numerical part of the structure."""
        R = self.R
        return self.M - R.T @ self.Ms @ R, self.C - R.T @ self.Cs @ R, self.K - R.T @ self.Ks @ R


def rods(of: Loop) -> tuple[Array, Array, Array]:
    """A, B of the states (q, P, v, x), each (P,) of them, under the commands; F of the forces by the states."""
    n, a = len(of.Kp), of.actuators
    inverse = np.linalg.inv(np.diag([one.m0 for one in a]) + of.Ms)
    q, p, v, x = (slice(k * n, (k + 1) * n) for k in range(4))
    A, B = np.zeros((4 * n, 4 * n)), np.zeros((4 * n, n))
    for k, one in enumerate(a):
        A[q, q][k, k], A[q, x][k, k], B[q][k, k] = -1 / one.tau, -of.Kp[k] / one.tau, of.Kp[k] / one.tau
        A[p, q][k, k], A[p, p][k, k], A[p, v][k, k] = one.Z0 / (one.A * one.Ka), -one.Cl / one.Ka, -one.A / one.Ka
    A[v, p] = inverse @ np.diag([one.A for one in a])
    A[v, v] = -inverse @ (np.diag([one.c0 for one in a]) + of.Cs)
    A[v, x] = -inverse @ of.Ks
    A[x, v] = np.eye(n)
    F = of.Ms @ A[v]
    F[:, x] += of.Ks
    F[:, v] += of.Cs
    return A, B, F


class _Stepped:
    """One sample of a loop under u = d."""

    def __init__(self, of: Loop, rate: float) -> None:
        n, count = len(of.M), len(of.Kp)
        A, B, self.F = rods(of)
        block = np.block([[A, B], [np.zeros((count, 5 * count))]])
        self.held = scipy.linalg.expm(block / rate)[: 4 * count]
        M, C, K = of.numeric
        inverse = np.linalg.inv(M)
        numeric = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ K, -inverse @ C]])
        drive = np.vstack([np.zeros((n, count + 1)), inverse @ np.column_stack([-of.R.T, -of.M @ of.i])])
        self.phi, self.g0, self.g1 = ramps(numeric, drive, 1 / rate)

    def numeric(self, z: Array, f: Array, last: Array, a: float, then: float) -> Array:
        """The numerical part a sample on."""
        return np.asarray(self.phi @ z + self.g0 @ [*f, a] + self.g1 @ [*(2 * f - last), then])


def simulate(of: Loop, ground: Array, rate: float) -> tuple[Array, Array, Array]:
    """Wanted d, measured x (m) and force f (N) at the samples, each (n, P), under u = d."""
    by, count, n = _Stepped(of, rate), len(of.Kp), len(ground)
    d, x, f = (np.zeros((n, count)) for _ in range(3))
    u = np.zeros((n + max(of.delays), count))
    rod, z, last = np.zeros(4 * count), np.zeros(2 * len(of.M)), np.zeros(count)
    for j in range(n):
        d[j], x[j], f[j] = of.R @ z[: len(of.M)], rod[3 * count :], by.F @ rod
        for p, delay in enumerate(of.delays):
            u[j + delay, p] = d[j, p]
        rod = by.held @ [*rod, *u[j]]
        z = by.numeric(z, f[j], last, ground[j], ground[min(j + 1, n - 1)])
        last = f[j]
    return d, x, f


def radius(of: Loop, rate: float) -> float:
    """The largest magnitude of a pole z of the loop: one sample of each unit state."""
    by, count, n = _Stepped(of, rate), len(of.Kp), len(of.M)
    lines = np.cumsum([0, *of.delays])
    after = []
    for state in np.eye(4 * count + 2 * n + count + lines[-1]):
        rod, z, last, line = np.split(state, np.cumsum([4 * count, 2 * n, count]))
        f, d = by.F @ rod, of.R @ z[:n]
        on = by.numeric(z, f, last, 0.0, 0.0)
        queues = [[*line[a + 1 : b], d[p]] for p, (a, b) in enumerate(pairwise(lines))]
        after.append(
            [*(by.held @ [*rod, *(line[a] for a in lines[:-1])]), *on, *f, *(u for one in queues for u in one)]
        )
    return float(np.abs(np.linalg.eigvals(np.array(after).T)).max())


def critical_delay(of: Loop) -> float:
    """The least delay τ (s) of otherwise perfect actuators at which det(Z(jω) + R' Zs(jω) R exp(-jωτ)) = 0, for a ω.

    Found by Newton's method for both unknowns from a grid of starts.
    """
    M, C, K = of.numeric

    def off(unknown: Array) -> list[float]:
        s, tau = 1j * unknown[0], unknown[1]
        whole = M * s**2 + C * s + K + of.R.T @ (of.Ms * s**2 + of.Cs * s + of.Ks) @ of.R * np.exp(-s * tau)
        det = complex(np.linalg.det(whole / np.linalg.norm(of.K)))
        return [det.real, det.imag]

    found = []
    modes = np.sqrt(scipy.linalg.eigvalsh(of.K, of.M))
    for omega in np.outer(modes, np.linspace(0.7, 1.3, 25)).ravel():
        for turn in np.linspace(0.05, 1.0, 12):
            root = scipy.optimize.root(off, [omega, turn * 2 * np.pi / omega], tol=1e-12)
            if root.success and np.hypot(*off(root.x)) < 1e-9 and root.x[0] > 1 and root.x[1] > 1e-9:
                found.append(float(root.x[1]))
    return min(found)

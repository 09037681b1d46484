"""A real-time hybrid simulation in one flat file: an independent judge of the program's loop.

One storey, M x'' + C x' + K x = -M a(t). A mass m and a spring k of it stand in the laboratory, moved by the linear
chain of Qian et al. (2014), eqs. (1)-(7); the rest is integrated by the computer:

    tau q' + q = Kp (u - x)         valve, with the position loop closed
    Ka P' = Z0 q / A - Cl P - A v   oil
    (m0 + m) v' = A P - c0 v - k x  rod and specimen
    f = k x + m v'                  load cell between rod and specimen
    (M - m) d'' + C d' + (K - k) d = -M a - f

At sample j the displacement x and the force f are read, u follows from the wanted d and from x, and is held from sample
j + delay on. Between samples the ground is a straight line, and the force goes on along the line through its last two
readings. Every step is an exact one by a matrix exponential. Nothing here comes from the program's library.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import scipy.linalg
import scipy.signal
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Actuator(NamedTuple):
    """Table 4 of the paper in SI, Z0 in its true unit."""

    Z0: float = 2.592e-6  # m⁴/s
    tau: float = 3.6e-3  # s
    Cl: float = 1e-11  # m³/(s·Pa)
    c0: float = 3200.0  # N·s/m
    m0: float = 4.25  # kg
    Ka: float = 1.39e-13  # m³/Pa
    A: float = 497e-6  # m²


class Structure(NamedTuple):
    """The whole: kg, N·s/m, N/m."""

    M: float = 87.5
    C: float = 3500.0
    K: float = 87.5e3


class Specimen(NamedTuple):
    """What of it stands in the laboratory: kg, N/m."""

    m: float = 8.75
    k: float = 17.5e3


def whole(structure: Structure, ground: Array, rate: float) -> Array:
    """Displacement of the whole structure under a ground acceleration, by scipy's simulation of linear systems."""
    M, C, K = structure
    system = scipy.signal.StateSpace([[0.0, 1.0], [-K / M, -C / M]], [[0.0], [-1.0]], [[1.0, 0.0]], [[0.0]])
    _, x, _ = scipy.signal.lsim(system, ground, np.arange(len(ground)) / rate)
    return np.asarray(x)


def ramps(A: Array, B: Array, h: float) -> tuple[Array, Array, Array]:
    """Phi, G0, G1 of z(j+1) = Phi z + G0 w(j) + G1 w(j+1) for inputs w that are straight lines over h."""
    n, m = B.shape
    block = np.zeros((n + 2 * m, n + 2 * m))
    block[:n, :n], block[:n, n : n + m], block[n : n + m, n + m :] = A * h, B * h, np.eye(m)
    e = scipy.linalg.expm(block)
    return e[:n, :n], e[:n, n : n + m] - e[:n, n + m :], e[:n, n + m :]


def rods(a: Actuator, s: Specimen, Kp: float) -> tuple[Array, Array]:
    """State matrices of (q, P, v, x) under the command u."""
    m = a.m0 + s.m
    A = np.array(
        [
            [-1 / a.tau, 0.0, 0.0, -Kp / a.tau],
            [a.Z0 / (a.A * a.Ka), -a.Cl / a.Ka, -a.A / a.Ka, 0.0],
            [0.0, a.A / m, -a.c0 / m, -s.k / m],
            [0.0, 0.0, 1.0, 0.0],
        ]
    )
    return A, np.array([[Kp / a.tau], [0.0], [0.0], [0.0]])


def poles(
    rate: float,
    Kp: float,
    delay: int,
    actuator: Actuator,
    structure: Structure,
    specimen: Specimen,
) -> NDArray[np.complex128]:
    """The poles s (1/s) of the loop under u = d: one sample of :func:`simulate` without ground, of each unit state."""
    a, w, s = actuator, structure, specimen
    A, B = rods(a, s, Kp)
    held = scipy.linalg.expm(np.block([[A, B], [np.zeros((1, 5))]]) / rate)
    numeric = np.array([[0.0, 1.0], [-(w.K - s.k) / (w.M - s.m), -w.C / (w.M - s.m)]])
    phi, g0, g1 = ramps(numeric, np.array([[0.0], [-1 / (w.M - s.m)]]), 1 / rate)
    after = []
    for state in np.eye(7 + delay):
        rod, z, last, u = state[:4], state[4:6], state[6], state[7:]
        f = s.k * rod[3] + s.m * (A[2] @ rod)
        on = phi @ z + g0[:, 0] * f + g1[:, 0] * (2 * f - last)
        after.append([*(held[:4, :4] @ rod + held[:4, 4] * u[0]), *on, f, *u[1:], z[0]])
    found = np.linalg.eigvals(np.array(after).T).astype(complex)
    return np.asarray(np.log(found[np.abs(found) > 1e-12]) * rate)


def simulate(
    ground: Array,
    rate: float,
    Kp: float,
    delay: int = 1,
    actuator: Actuator | None = None,
    structure: Structure | None = None,
    specimen: Specimen | None = None,
    law: Callable[[float, float], float] = lambda d, _y: d,
) -> tuple[Array, Array, Array]:
    """Wanted d, measured x (m) and force f (N) at the samples, each (n,), under u = law(d, x)."""
    a, w, s = actuator or Actuator(), structure or Structure(), specimen or Specimen()
    A, B = rods(a, s, Kp)
    held = scipy.linalg.expm(np.block([[A, B], [np.zeros((1, 5))]]) / rate)
    M, C, K = w.M - s.m, w.C, w.K - s.k
    numeric = np.array([[0.0, 1.0], [-K / M, -C / M]])
    phi, g0, g1 = ramps(numeric, np.array([[0.0, 0.0], [-1 / M, -w.M / M]]), 1 / rate)
    n = len(ground)
    d, x, f, u = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n + delay)
    rod, z, last = np.zeros(4), np.zeros(2), 0.0
    for j in range(n):
        d[j], x[j] = z[0], rod[3]
        f[j] = s.k * rod[3] + s.m * (A[2] @ rod)
        u[j + delay] = law(d[j], x[j])
        rod = held[:4, :4] @ rod + held[:4, 4] * u[j]
        after = ground[min(j + 1, n - 1)]
        z = phi @ z + g0 @ [f[j], ground[j]] + g1 @ [2 * f[j] - last, after]
        last = f[j]
    return d, x, f

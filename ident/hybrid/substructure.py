"""The numerical part of a hybrid simulation, integrated exactly from sample to sample, and the whole structure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ident.hybrid.case import Case
from ident.simulation.jit import jit

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Substructure:
    """M_n x'' + C_n x' + K_n x = −M 1 a(t) − e f(t) from sample to sample, z = [x, x'].

    z(k+1) = Φ z(k) + F0 f(k) + F1 f̂(k+1) + G0 a(k) + G1 a(k+1), exact for straight lines between samples; the force of
    the next sample is not measured yet, and f̂(k+1) = 2 f(k) − f(k−1) goes on as it came. The force of the ground acts
    on the whole mass: the specimen stands still against the ground where the structure does, so its load cell knows
    nothing of it. Φ (2n, 2n), the others (2n,); e picks storey `place`.
    """

    phi: Array
    force0: Array
    force1: Array
    ground0: Array
    ground1: Array
    place: int


def numerical(case: Case) -> Substructure:
    """The part that is left to the computer."""
    return _sampled(case, case.numerical_mass, case.numerical_damping, case.numerical_stiffness)


def reference(case: Case, ground: Array) -> Array:
    """The displacement (m) of the storey where the specimen stands, of the whole structure, (n,): what should come out.

    Exact at the samples for a ground acceleration (n,) that is a straight line between them.
    """
    whole = _sampled(case, case.mass, case.damping, case.stiffness)
    return np.asarray(_recursion(whole.phi, whole.ground0, whole.ground1, ground, case.place))


@jit(nogil=True)
def _recursion(phi: Array, now: Array, then: Array, drive: Array, place: int) -> Array:
    out, z = np.zeros(len(drive)), np.zeros(len(phi))
    for k in range(1, len(drive)):
        on = now * drive[k - 1] + then * drive[k]
        for i in range(len(z)):
            for j in range(len(z)):
                on[i] += phi[i, j] * z[j]
        z = on
        out[k] = z[place]
    return out


def _sampled(case: Case, mass: Array, damping: Array, stiffness: Array) -> Substructure:
    n = case.storeys
    inverse, period = np.linalg.inv(mass), 1.0 / case.sample_rate
    pushed = np.zeros((n, 2))
    pushed[case.place, 0] = -1.0
    pushed[:, 1] = -case.mass @ np.ones(n)
    # A ramp over one sample, and a constant, drive the system: one exponential holds both responses.
    system = np.zeros((2 * n + 4, 2 * n + 4))
    system[:n, n : 2 * n] = np.eye(n)
    system[n : 2 * n, :n], system[n : 2 * n, n : 2 * n] = -inverse @ stiffness, -inverse @ damping
    system[n : 2 * n, 2 * n : 2 * n + 2] = inverse @ pushed
    system[2 * n : 2 * n + 2, 2 * n + 2 :] = np.eye(2) / period
    found = scipy.linalg.expm(system * period)[: 2 * n]
    constant, ramp = found[:, 2 * n : 2 * n + 2], found[:, 2 * n + 2 :]
    first = constant - ramp
    return Substructure(found[:, : 2 * n], first[:, 0], ramp[:, 0], first[:, 1], ramp[:, 1], case.place)

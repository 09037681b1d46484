"""The linear actuator against a measured force: an independent judge of runs that are driven by command and force.

    tau q' + q = Kp (u(t - T) - x)                      position loop, the command late by T; valve
    Ka P' = Z0/A q - Cl P - A v                         flow, pressure
    m0 v' = A P - c0 v - f,  x' = v                     the rod against the load cell's force

Between the samples the force is a straight line, the command one too or held; it is zero before the record. Each piece
between two corners is advanced exactly by the matrix exponential. All is SI; nothing comes from the program's library.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from tests.reference.qian_reference import SAMPLE_RATE, Plant

Samples = NDArray[np.float64]
Q, P, V, X, U, F, DU, DF = range(8)


def respond(plant: Plant, gain: float, command: Samples, force: Samples, delay: float, hold: str) -> Samples:
    """The displacement (m) from rest, shape (n,)."""
    part = delay * SAMPLE_RATE % 1.0  # of a sample: where the corners of the late command lie
    first, second = (expm(system(plant, gain) * share / SAMPLE_RATE) for share in (part, 1.0 - part))
    number = np.arange(len(force))
    state, output = np.zeros(8), np.zeros(len(force))
    for k in range(len(force) - 1):
        for begin, end, advance in ((k, k + part, first), (k + part, k + 1, second)):
            state[[U, DU]] = late(command, begin, end, delay * SAMPLE_RATE, hold)
            state[F], state[DF] = np.interp(begin, number, force), (force[k + 1] - force[k]) * SAMPLE_RATE
            state = advance @ state
        output[k + 1] = state[X]
    return output


def late(command: Samples, begin: float, end: float, delay: float, hold: str) -> tuple[float, float]:
    """The late command at the beginning of a piece between two of its corners, and its rate; times in samples."""
    left = int(np.floor(0.5 * (begin + end) - delay))
    if left < 0:
        return 0.0, 0.0
    rise = command[left + 1] - command[left] if hold == "linear" else 0.0
    return command[left] + rise * (begin - delay - left), rise * SAMPLE_RATE


def system(plant: Plant, gain: float) -> NDArray[np.float64]:
    """The rates of states and inputs as a matrix."""
    rates = np.zeros((8, 8))
    rates[Q, [Q, X, U]] = np.array([-1.0, -gain, gain]) / plant.tau
    rates[P, [Q, P, V]] = np.array([plant.Z0 / plant.A, -plant.Cl, -plant.A]) / plant.Ka
    rates[V, [P, V, F]] = np.array([plant.A, -plant.c0, -1.0]) / plant.m0
    rates[X, V] = rates[U, DU] = rates[F, DF] = 1.0
    return rates

"""The linear actuator with a flow gain that changes with time: an independent judge of equations that read the time.

Kutta's classical rule with several sub-steps a sample, all runs of a matrix side by side; flat, SI, from rest.

    tau q' = Kp (u - x) - q,    Q = Z0/A q g(t)
    Ka P' = Q - Cl P - A v,     (m0 + mL) v' = A P - (c0 + cL) v - k x
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from tests.reference import qian_reference as linear

Samples = NDArray[np.float64]
SUBSTEPS = 3


def displacements(
    plant: linear.Plant, cells: Sequence[linear.Cell], commands: Samples, gain: Callable[[float], float]
) -> Samples:
    """Displacements (runs, n) for commands (runs, n) that are straight between samples."""
    Kp, mass, k, c = (
        np.array([getattr(cell, name) for cell in cells]) for name in ("gain", "mass", "stiffness", "damping")
    )
    h = 1 / (linear.SAMPLE_RATE * SUBSTEPS)

    def rates(t: float, u: Samples, s: Samples) -> Samples:
        q, P, v, x = s
        flow = plant.Z0 / plant.A * q * gain(t)
        return np.array(
            [
                (Kp * (u - x) - q) / plant.tau,
                (flow - plant.Cl * P - plant.A * v) / plant.Ka,
                (plant.A * P - (plant.c0 + c) * v - k * x) / (plant.m0 + mass),
                v,
            ]
        )

    s, out = np.zeros((4, len(cells))), np.zeros_like(commands)
    for n in range(commands.shape[1] - 1):
        out[:, n] = s[3]
        rise = commands[:, n + 1] - commands[:, n]
        for step in range(SUBSTEPS):
            t = (n * SUBSTEPS + step) * h
            u0, u1, u2 = (commands[:, n] + rise * (step + share) / SUBSTEPS for share in (0, 0.5, 1))
            a = rates(t, u0, s)
            b = rates(t + h / 2, u1, s + h / 2 * a)
            c3 = rates(t + h / 2, u1, s + h / 2 * b)
            d = rates(t + h, u2, s + h * c3)
            s = s + h / 6 * (a + 2 * b + 2 * c3 + d)
    out[:, -1] = s[3]
    return out

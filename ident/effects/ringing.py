"""Whether a record rings: whether its output answers the command with a damped oscillation.

Of y and u, means over q samples, y_k = Σ a_i y_(k−i) + Σ b_i u_(k−i) of fourth order is fitted by least squares (Ljung
1999, section 10.1); it rings where a pair of its poles exp(s) has a damping ratio −Re s/|s| below 0.5. Noise puts pairs
near half the sample rate, and the poles of what is sampled too finely on the real axis: so pairs above 1.2 rad count
not, and q is doubled while 100 means are left.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ORDER = 4
FEWEST = 100
"""Means that a fit of nine numbers is made of at least. Test: tests/effects/test_ringing.py"""
FASTEST, SLOWEST = 1.2, 0.05
"""Radians in q samples between which a pair of poles is one of the machine. Test: tests/effects/test_ringing.py"""
DAMPING = 0.5
"""Damping ratio below which a step is overshot by a sixth, and one resonance is seen. Test: as above"""


def rings(command: Array, output: Array) -> bool:
    """Whether an output (n,) answers its command (n,) with a damped oscillation, at any q."""
    q = 1
    while len(output) // q >= FEWEST:
        count = len(output) // q * q
        means = (signal[:count].reshape(-1, q).mean(axis=1) for signal in (command, output))
        if _has_pair(*means):
            return True
        q *= 2
    return False


def _has_pair(u: Array, y: Array) -> bool:
    u, y, n = u - u.mean(), y - y.mean(), len(y)
    past = [y[ORDER - i : n - i] for i in range(1, ORDER + 1)] + [u[ORDER - i : n - i] for i in range(ORDER + 1)]
    samples = np.stack((*past, y[ORDER:]), axis=1)
    triangle = np.asarray(np.linalg.qr(samples, mode="r"))  # of ten rows, as well conditioned as all samples
    found, *_ = np.linalg.lstsq(triangle[:, :-1], triangle[:, -1], rcond=None)
    poles = np.log(np.roots(np.append(1.0, -found[:ORDER])).astype(np.complex128) + 1e-12)
    size = np.abs(poles)
    within = (poles.imag > 0) & (size > SLOWEST) & (size < FASTEST)
    return bool(np.any(within & (-poles.real < DAMPING * size)))

"""Whether a record rings: whether its output answers the command with a damped oscillation.

Of y and u, means over q samples, y_k = Σ a_i y_(k−i) + Σ b_i u_(k−i) of fourth order is fitted by least squares (Ljung
1999, section 10.1); it rings where a pair of its poles exp(s) has a damping ratio −Re s/|s| below 0.5, at |s|. Noise
puts pairs near half the sample rate, and the poles of what is sampled too finely on the real axis: so pairs above 1.2
rad count not, and q is doubled while 100 means are left. Of several pairs the least damped is the machine's.

A position integrates, and by least squares the noise of its samples hides the poles. Its equation is solved by
instrumental variables, which are the past of the model's own output (Ljung 1999, section 7.6, method of Young), from
the solution by least squares on.
"""

from __future__ import annotations

from collections.abc import Iterable
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ident.linear_filter import linear_filter
from ident.run import Run

Array = NDArray[np.float64]
ORDER = 4
FEWEST = 100
"""Means that a fit of nine numbers is made of at least. Test: tests/effects/test_ringing.py"""
FASTEST, SLOWEST = 1.2, 0.05
"""Radians in q samples between which a pair of poles is one of the machine. Test: tests/effects/test_ringing.py"""
DAMPING = 0.5
"""Damping ratio below which a step is overshot by a sixth, and one resonance is seen. Test: as above"""
REFINED = 3
"""Times that the instruments are computed again from the latest solution. Test: tests/effects/test_ringing.py"""
_known: WeakKeyDictionary[Run, float | None] = WeakKeyDictionary()


def resonances(runs: Iterable[Run]) -> list[float]:
    """The frequencies, rad/s, at which the runs that have a command answer it with a damped oscillation."""
    found = ((run.sample_rate, _of_run(run)) for run in runs if "command" in run.channels)
    return [rate * frequency for rate, frequency in found if frequency is not None]


def _of_run(run: Run) -> float | None:
    """The frequency, rad a sample, at which a run rings: worked out once, though several effects ask for it."""
    if run not in _known:
        _known[run] = ringing(run.command, run.measured, run.output == "displacement")
    return _known[run]


def ringing(command: Array, output: Array, integrates: bool = False) -> float | None:
    """The frequency, rad a sample, at which an output (n,) answers its command (n,) with a damped oscillation.

    `integrates` is whether the output is a position. None where it does at no q.
    """
    found: list[tuple[float, float]] = []
    q = 1
    while len(output) // q >= FEWEST:
        count = len(output) // q * q
        u, y = (signal[:count].reshape(-1, q).mean(axis=1) for signal in (command, output))
        pairs = _pairs(u - u.mean(), y - y.mean(), integrates)
        found += [(damping, frequency / q) for damping, frequency in pairs]
        q *= 2
    return min(found)[1] if found else None


def _pairs(u: Array, y: Array, integrates: bool) -> list[tuple[float, float]]:
    """Damping ratio and frequency, rad a sample, of each pair of poles with which y answers u."""
    samples = np.column_stack((_regressors(y, u), y[ORDER:]))
    triangle = np.asarray(np.linalg.qr(samples, mode="r"))  # of ten rows, as well conditioned as all samples
    found, *_ = np.linalg.lstsq(triangle[:, :-1], triangle[:, -1], rcond=None)
    for _ in range(REFINED if integrates else 0):
        instruments = _regressors(_answer(found, u), u)
        found, *_ = np.linalg.lstsq(instruments.T @ samples[:, :-1], instruments.T @ samples[:, -1], rcond=None)
    poles = np.log(_poles(found) + 1e-12)
    size = np.abs(poles)
    within = (poles.imag > 0) & (size > SLOWEST) & (size < FASTEST) & (-poles.real < DAMPING * size)
    return [(float(-pole.real / abs(pole)), float(abs(pole))) for pole in poles[within]]


def _regressors(y: Array, u: Array) -> Array:
    """The regressors of each sample of y: the past of y and of u, and u itself, (n − 4, 9)."""
    past = [y[ORDER - i : len(y) - i] for i in range(1, ORDER + 1)]
    return np.stack((*past, *(u[ORDER - i : len(y) - i] for i in range(ORDER + 1))), axis=1)


def _poles(found: Array) -> NDArray[np.complex128]:
    return np.roots(np.append(1.0, -found[:ORDER])).astype(np.complex128)


def _answer(found: Array, u: Array) -> Array:
    """The output of the model alone for the command u, (n,); poles outside of the unit circle are mirrored into it."""
    poles = _poles(found)
    poles = np.where(np.abs(poles) > 1.0, 1.0 / np.conj(poles), poles)
    return linear_filter(found[ORDER:], np.real(np.poly(poles)), u)

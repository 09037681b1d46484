"""Whether records ring: whether their output answers the command with a damped oscillation.

Of y and u, means over q samples, y_k = Σ a_i y_(k−i) + Σ b_i u_(k−i) of fourth order is solved by least squares, and
from there by instrumental variables, which are the past of the model's own output (Ljung 1999, sections 10.1 and 7.6):
the noise of y would damp and move the poles. A pair of poles exp(s) oscillates where its damping ratio −Re s/|s| is
between 0 and 1/√2, at |s|. Noise puts pairs near half the sample rate, and the poles of what is sampled too finely on
the real axis: so pairs above 1.2 rad count not, and q is doubled while 100 means are left.

A resonance of the machine shows twice, at one frequency: in two runs, or in one of several runs and both of its halves;
of a single run, in two of the run and its halves. One that noise or dry friction feigns in one run does not. Of several
the least damped is the machine's.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ident.linear_filter import linear_filter
from ident.run import Run

Array = NDArray[np.float64]
Mode = tuple[float, float]
"""Damping ratio and frequency of a pair of poles, rad/s or rad a sample."""
ORDER = 4
FEWEST = 100
"""Means that a fit of nine numbers is made of at least. Test: tests/effects/test_ringing.py"""
FASTEST, SLOWEST = 1.2, 0.05
"""Radians in q samples between which a pair of poles is one of the machine. Test: tests/effects/test_ringing.py"""
DAMPING = 0.71
"""Damping ratio below which the frequency response has a peak, 1/√2. Test: as above"""
REFINED = 3
"""Times that the instruments are computed again from the latest solution. Test: tests/effects/test_ringing.py"""
ALIKE = 0.07
"""Relative difference of two frequencies that are one: three standard errors of a mode that twenty periods show.
Test: tests/effects/test_ringing.py"""
WHOLE, HALVES = 0, (1, 2)
_known: WeakKeyDictionary[Run, dict[int, list[Mode]]] = WeakKeyDictionary()


def resonance(runs: Iterable[Run]) -> float | None:
    """The frequency, rad/s, at which the runs that have a command answer it with a damped oscillation, or None."""
    driven = [run for run in runs if "command" in run.channels]
    if len(driven) == 1:
        return shown_twice([_of(driven[0], part) for part in (WHOLE, *HALVES)])
    found = shown_twice([_of(run, WHOLE) for run in driven])
    throughout = (shown_throughout(*(_of(run, part) for part in (WHOLE, *HALVES))) for run in driven)
    return found if found is not None else next((one for one in throughout if one is not None), None)


def shown_throughout(whole: Sequence[Mode], *halves: Sequence[Mode]) -> float | None:
    """The frequency of the least damped mode of a run that each of its halves shows, too, or None."""
    found = [mode for mode in whole if all(any(_alike(mode, other) for other in half) for half in halves)]
    return min(found)[1] if found else None


def shown_twice(of: Sequence[Sequence[Mode]]) -> float | None:
    """The frequency of the least damped of the modes that two of several records show, or None."""
    found = [
        (max(one[0], other[0]), float(np.sqrt(one[1] * other[1])))
        for number, modes in enumerate(of)
        for one in modes
        for others in of[:number]
        for other in others
        if _alike(one, other)
    ]
    return min(found)[1] if found else None


def _alike(one: Mode, other: Mode) -> bool:
    """Whether two modes have one frequency."""
    return abs(float(np.log(one[1] / other[1]))) < ALIKE


def _of(run: Run, part: int) -> list[Mode]:
    """The modes, rad/s, of a run or of one of its halves: worked out once, though several effects ask for them."""
    known = _known.setdefault(run, {})
    if part not in known:
        half = run.length // 2
        samples = (slice(None), slice(half), slice(half, None))[part]
        found = modes(run.command[samples], run.measured[samples])
        known[part] = [(damping, run.sample_rate * frequency) for damping, frequency in found]
    return known[part]


def modes(command: Array, output: Array) -> list[Mode]:
    """The damped oscillations, rad a sample, with which an output (n,) answers its command (n,), at every q."""
    found: list[Mode] = []
    q = 1
    while len(output) // q >= FEWEST:
        count = len(output) // q * q
        u, y = (signal[:count].reshape(-1, q).mean(axis=1) for signal in (command, output))
        found += [(damping, frequency / q) for damping, frequency in _pairs(u - u.mean(), y - y.mean())]
        q *= 2
    return found


def _pairs(u: Array, y: Array) -> list[Mode]:
    """Damping ratio and frequency, rad a sample, of each pair of poles with which y answers u."""
    samples = np.column_stack((_regressors(y, u), y[ORDER:]))
    triangle = np.asarray(np.linalg.qr(samples, mode="r"))  # of ten rows, as well conditioned as all samples
    found: Array = np.asarray(np.linalg.lstsq(triangle[:, :-1], triangle[:, -1], rcond=None)[0], float)
    for _ in range(REFINED):
        instruments = _regressors(_answer(found, u), u)
        fitted = np.linalg.lstsq(instruments.T @ samples[:, :-1], instruments.T @ samples[:, -1], rcond=None)
        found = np.asarray(fitted[0], float)
    poles = np.log(_poles(found) + 1e-12)
    size = np.abs(poles)
    damped = (poles.real < 0) & (-poles.real < DAMPING * size)
    within = damped & (poles.imag > 0) & (size > SLOWEST) & (size < FASTEST)
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
    outside = np.abs(poles) > 1.0
    poles[outside] = 1.0 / np.conj(poles[outside])
    return linear_filter(found[ORDER:], np.asarray(np.real(np.poly(poles)), float), u)

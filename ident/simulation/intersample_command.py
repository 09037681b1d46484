"""The command between its samples, as a run's `hold` says.

Over each sample it is a polynomial through q nodes at shares of the sample: its ends, of a line ("linear"), of which a
held command ("zoh") has the first alone. One that is "band-limited" has no power from half the sample rate on, so that
its samples say all of it (Shannon 1949): with τ in samples

    u(k + τ) = Σ_j u[j] sinc(k + τ − j) w(k + τ − j),

w a Kaiser window (Kaiser 1974) over :data:`REACH` samples to each side. Below 0.9 of half the rate it is right within
2e-5 of its size. Before the record stands what is known of it, zero where the machine begins at rest, else the record
turned about its first sample, as behind its last one: there the curve goes on without a corner.
"""

from __future__ import annotations

from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ident.run import Run

Array = NDArray[np.float64]
REACH = 32
"""Samples to each side that the value between two samples is made of. Why: with the window's shape it passes 0.9 of
half the rate and lets nothing back from 1.1 of it, both within 2e-5; half as many would pass 0.8."""
_SHAPE = 10.0  # of the window, β: what is let through beyond is 100 dB down
_DEGREE = 7  # of the polynomial over a sample: a sine at half the rate is met within 4e-6
_ENDS = np.array([0.0, 1.0])
_CHEBYSHEV = 0.5 - 0.5 * np.cos(np.pi * np.arange(_DEGREE + 1) / _DEGREE)
_known: WeakKeyDictionary[Run, Array] = WeakKeyDictionary()
"""The nodes of band-limited commands: a fit asks for the same ones thousands of times."""


def nodes(hold: str) -> Array:
    """The shares of a sample at which the command is to be known, (q,); the first is the sample itself."""
    return _CHEBYSHEV if hold == "band-limited" else _ENDS


def at_nodes(run: Run) -> Array:
    """The command of a run at the nodes of each sample, (n, q)."""
    if run.hold != "band-limited":
        return ends(run.command)
    if run not in _known:
        _known[run] = band_limited(run, nodes(run.hold))
    return _known[run]


def ends(samples: Array) -> Array:
    """The value at each sample and at the next, (n,) → (n, 2); the last one stays."""
    return np.column_stack([samples, np.append(samples[1:], samples[-1])])


def band_limited(run: Run, shares: Array, before: int = 0) -> Array:
    """The band-limited command of a run at `shares` (q,) of each sample, and of `before` in front, (before + n, q)."""
    command, missing = run.command, REACH + before
    known = command[:0] if run.past is None else run.past[-missing:]
    missing -= len(known)
    front = known[0] if len(known) else command[0]
    if len(known) or run.begins != "at rest":
        lead = 2 * front - np.concatenate([known, command])[missing:0:-1][:missing]
        lead = np.concatenate([np.full(missing - len(lead), lead[0] if len(lead) else front), lead])
    else:
        lead = np.zeros(missing)
    behind = 2 * command[-1] - command[-2 : -REACH - 2 : -1]
    behind = np.concatenate([behind, np.full(REACH - len(behind), behind[-1])])
    whole = np.concatenate([lead, known, command, behind])
    return np.column_stack([_between(whole, float(share)) for share in shares])


def _between(whole: Array, share: float) -> Array:
    """The values a share of a sample behind each sample but the first and the last :data:`REACH`."""
    if share in _ENDS:
        return whole[REACH + int(share) : len(whole) - REACH + int(share)]
    away = share - np.arange(-REACH + 1, REACH + 1)
    weights = np.sinc(away) * np.i0(_SHAPE * np.sqrt(np.maximum(1.0 - (away / REACH) ** 2, 0.0)))
    weights /= weights.sum()  # a constant stays what it is
    return np.convolve(whole, weights[::-1], mode="valid")[1:]

"""The periods of a command that repeats itself within one run, as repeats of one another.

A multisine or a random binary sequence is often run several times without a break and stored as one record. Whatever
acts on it again after a period P does so with the same past, so that the output differs by noise alone once the start
has died away. The period is the first lag at which the command agrees with itself again,

    ρ(L) = 1 − ⟨(u[k+L] − u[k])²⟩ / (2 var u)

(the normalised autocorrelation, in the form of a variogram, which needs no mean of both ends).
"""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

from ident.noise.criteria import NOISE_CRITERIA
from ident.noise.periodic import fundamental
from ident.noise.repeats import Repeat, same_inputs
from ident.run import BENCH, Run

Array = NDArray[np.float64]
_OF = NOISE_CRITERIA.own_periods


def own_repeats(run: Run) -> list[Repeat]:
    """The pairs of successive periods of a run, the last one first, as long as they and what came before are the same.

    None where its command is not periodic, or is so in one line of the spectrum, whose noise
    :mod:`ident.noise.periodic` tells.
    """
    if "command" not in run.channels or run.kind in BENCH or fundamental(run.command, run.sample_rate) is not None:
        return []
    if (length := period(run.command)) is None:
        return []
    before, pairs = round(_OF.settled * length), []
    for begin in range(run.length - 2 * length, before - 1, -length):
        earlier, later = ((at, at + length) for at in (begin, begin + length))
        if not same_inputs(*(run.part(first - before, end) for first, end in (earlier, later))):
            break
        pairs.append(Repeat(run.part(*earlier), run.part(*later)))
    return pairs


def period(command: Array) -> int | None:
    """The samples of a period of a command, (n,); None where it does not repeat itself behind what it began with."""
    later = command[int(len(command) * _OF.settled / (2.0 + _OF.settled)) :]
    size, most = float(np.var(later)), len(later) // 2
    if size <= 0.0 or most < _OF.samples_of_a_period:
        return None
    likeness = 1.0 - _variogram(later - later.mean(), most) / (2.0 * size)
    unlike = np.flatnonzero(likeness < _OF.unlike)
    alike = np.flatnonzero(likeness > _OF.alike)
    alike = alike[alike > unlike[0]] if len(unlike) else unlike
    if not len(alike):
        return None
    first = alike[: int(np.argmax(np.append(np.diff(alike) > 1, True))) + 1]
    found = int(first[np.argmax(likeness[first])])
    return found if found >= _OF.samples_of_a_period else None


def _variogram(signal: Array, most: int) -> Array:
    """⟨(u[k+L] − u[k])²⟩ for every lag L from 0 to `most`, by the fast Fourier transform."""
    n = len(signal)
    length = scipy.fft.next_fast_len(n + most, real=True)  # no lag up to `most` wraps round
    spectrum = np.fft.rfft(signal, length)
    products = np.fft.irfft(np.abs(spectrum) ** 2, length)[: most + 1]
    squares = np.concatenate([[0.0], np.cumsum(signal**2)])
    lags = np.arange(most + 1)
    found: Array = (squares[n - lags] + squares[n] - squares[lags] - 2.0 * products) / (n - lags)
    return found

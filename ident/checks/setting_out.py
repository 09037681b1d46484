"""Where an output sets out by itself: it rests or creeps, then goes as quick motions go, and its past does not say so.

A machine that swings or sinks goes on from its last values as it does at other times while its inputs rest: a linear
law of those values, found by least squares from all that the record shows of it at rest, predicts the motion.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy  # ndimage, which takes long to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.run import Samples

QUICK = 0.9  # share of the motions that are slower than a quick one
REST = 2  # durations of a quick motion for which the output has rested or crept before it sets out
SLOW, FAST = 0.15, 0.35  # of a quick motion: it rests, and sets out
NOISY = 12  # deviations of the noise that a quick motion goes at least
NORMAL = 0.6745  # median of the absolute values of normal noise of deviation 1
BEND = 2.5  # durations of a quick motion from the middle of its creep to where it has set out
AHEAD = 1.5  # durations of a quick motion from where its past is known to where it has set out
PAST = 5  # values over the time of rest that stand for the state
PREDICTED = 0.4  # of a motion that its past does not say, up to which it went on by itself


@dataclass(frozen=True)
class Motion:
    """How an output (n,) moves within so many `samples`: its `way` from each on, (n − samples,), and a `quick` one."""

    output: Samples
    samples: int
    way: Samples
    quick: float

    @classmethod
    def of(cls, y: Samples, samples: int, least: float, at_rest: NDArray[np.bool_]) -> Motion:
        """Of an output, averaged over half of a quick motion; that goes at least so far, and beyond noise at rest."""
        output = np.asarray(scipy.ndimage.uniform_filter1d(y, samples // 2), np.float64)
        way = output[samples:] - output[:-samples]
        at = np.flatnonzero(at_rest) + REST * samples
        bends = np.abs(way[at] - way[at - samples])
        noise = float(np.median(bends)) / (NORMAL * np.sqrt(3.0)) if len(at) else 0.0
        return cls(output, samples, way, max(float(np.quantile(np.abs(way), QUICK)), least, NOISY * noise))

    def starts(self, at_rest: NDArray[np.bool_]) -> list[int]:
        """The samples at which the output sets out, of those from which on (m,) all inputs rest for 4 quick motions."""
        rest = REST * self.samples
        places = np.flatnonzero(self._sets_out() & at_rest)
        groups = [group for group in np.split(places, np.flatnonzero(np.diff(places) > rest) + 1) if len(group)]
        fast = np.abs(self.way) >= FAST * self.quick
        begins = np.array([group[0] + rest + np.argmax(fast[group[0] + rest :]) for group in groups], np.intp)
        if not len(begins):
            return []
        unpredicted = np.abs(self._unpredicted(np.flatnonzero(at_rest) + rest, begins))
        return [int(k) for k in begins[unpredicted > PREDICTED * np.abs(self.way[begins])]]

    def _sets_out(self) -> NDArray[np.bool_]:
        """Whether the output rests or creeps from each sample on, and then sets out.

        A creep is steady and slower than what sets out. A speed that changes on as it did within the creep has not set
        out, and what stops has neither.
        """
        rest, least = REST * self.samples, FAST * self.quick
        count = len(self.way) - rest - self.samples
        most, fewest, up, down = (
            _ahead(of, self.way[begin:], self.samples)[:count]
            for begin in (0, rest)
            for of in (scipy.ndimage.maximum_filter1d, scipy.ndimage.minimum_filter1d)
        )
        creep, bend = 0.5 * (most + fewest), most - fewest
        rests = np.maximum(most, -fewest) <= SLOW * self.quick
        far = np.where(rests, least, np.maximum(least, BEND * bend))
        steady = (bend <= 2.0 * SLOW * self.quick) & (np.abs(creep) < least)
        return np.asarray(steady & ((up - np.maximum(creep, 0.0) >= far) | (np.minimum(creep, 0.0) - down >= far)))

    def _unpredicted(self, known: NDArray[np.intp], begins: NDArray[np.intp]) -> Samples:
        """What the past does not say of the ways from shortly before each begin on, by the law of those at `known`."""
        y, later = self.output, int(AHEAD * self.samples)

        def past(at: NDArray[np.intp]) -> Samples:
            back = REST * self.samples * np.arange(PAST) // (PAST - 1)
            return np.column_stack([np.ones(len(at)), y[np.maximum(at[:, None] - back, 0)]])

        known = known[:: max(1, self.samples // 4)]
        law = np.linalg.lstsq(past(known), y[known + later] - y[known])[0]
        before = begins + self.samples - later
        return np.asarray(y[before + later] - y[before] - past(before) @ law)


def _ahead(of: Callable[..., Samples], x: Samples, samples: int) -> Samples:
    """The largest or the least of so many samples from each on."""
    return np.asarray(of(x, samples, origin=-(samples // 2)))

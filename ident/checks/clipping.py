"""A channel that was cut off at the end of its range."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ident.checks.finding import Finding
from ident.rounding import ROUNDING
from ident.run import Run, Samples
from ident.words.message import message

PLATEAU = 4  # equal samples; three may be chance in a record of few bits
PLATEAUS = 3  # peaks that end at the very same value
STEP = 0.2  # of the usual step: a cut signal arrives at speed, one that comes to rest arrives slowly
RESOLUTIONS = 3.0  # a rounded peak is left by one step of the resolution, a cut one by more
NEAR = 2e-3  # of the range; in noise the fifth highest peak lies ten times deeper
ON_ITS_WAY = 3  # steps before a plateau in which a cut signal moved; a jump on a clock that was evened takes two
BETWEEN = 0.05  # of the range
PEAKS = 5
AT_REST = 0.4  # of the samples: a signal of levels, not a cut one
FULL = 1.0  # of a command that is a share of full scale: a lever at its stop, a duty of 100 %
LEVELS = ("static", "speed-levels", "speed-continuous")


def clipping(run: Run) -> Iterator[Finding]:
    """Peaks of command, output or force that all end at one value."""
    if run.kind in LEVELS:
        return
    for name in dict.fromkeys(("command", run.output, "force")):
        signal = run.channels.get(name)
        if signal is None:
            continue
        for side, flipped in (("highest", signal), ("lowest", -signal)):
            count = peaks_at_the_top(flipped) if run.kind == "blwn" else plateaus_at_the_top(flipped)
            level = float(signal.max() if side == "highest" else signal.min())
            if count and not (name == "command" and _full_scale(level, run.units.get(name))):
                key = "check.clipped_high" if side == "highest" else "check.clipped_low"
                unit = run.units.get(name, "")
                text = message(key, channel=name, run=run.id, count=count, level=level, unit=unit)
                yield Finding.of(run.id, "doubt", "clipping", text)


def _full_scale(level: float, unit: str | None) -> bool:
    """Whether a command ends where it has to: nobody can ask for more than all, and nothing is cut off."""
    return unit == "1" and abs(abs(level) - FULL) <= ROUNDING * FULL


def peaks_at_the_top(signal: Samples) -> int:
    """Number of separate peaks of a random signal within NEAR of its range from the top; 0 below PEAKS."""
    near = signal >= signal.max() - NEAR * float(np.ptp(signal))
    count = len(np.unique(_visits(signal)[near]))
    return count if count >= PEAKS else 0


def _visits(signal: Samples) -> NDArray[np.intp]:
    """For each sample the number of times that the signal has reached the top since the first sample.

    Two peaks are separate where it falls by BETWEEN between them, which its noise does not.
    """
    high = signal >= signal.max() - BETWEEN * float(np.ptp(signal))
    return np.cumsum(high & ~np.concatenate([[False], high[:-1]]))


def plateaus_at_the_top(signal: Samples) -> int:
    """Number of separate plateaus of equal samples at the top that are entered at speed; 0 below PLATEAUS.

    A signal that jumps there from rest, between two samples or three, is one of levels: what is cut off was on its way
    before.
    """
    top = signal == signal.max()
    if top.mean() > AT_REST:
        return 0
    edges = np.flatnonzero(np.diff(np.concatenate([[False], top, [False]]).astype(np.int8)))
    starts, ends = edges[::2], edges[1::2]
    long = (ends - starts >= PLATEAU) & (starts >= ON_ITS_WAY)
    steps = np.abs(np.diff(signal))
    moving = steps[steps > 0]
    if not long.any() or not len(moving):
        return 0
    least = max(STEP * float(np.sqrt(np.mean(moving**2))), RESOLUTIONS * float(moving.min()))
    before = steps[starts[long][:, None] - np.arange(1, ON_ITS_WAY + 1)]
    entered = (before[:, 0] > least) & (before > 0).all(axis=1)
    count = len(np.unique(_visits(signal)[starts[long][entered]]))
    return count if count >= PLATEAUS else 0

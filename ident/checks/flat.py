"""A channel that stood still while the other moved."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ident.checks.finding import Finding
from ident.run import Run, Samples
from ident.words.message import message

SECONDS = 0.05  # longer than any rest of a rounded signal in a band of tens of Hz
SAMPLES = 32
USUAL = 4.0  # times the median change from sample to sample
MOVED = 0.5  # of the other channel's standard deviation, from end to end of its range meanwhile


def flat(run: Run) -> Iterator[Finding]:
    """The longest part in which command or output repeats one value exactly while the other one moves."""
    if "command" not in run.channels or run.units.get("command") == "A":
        return
    least = max(SAMPLES, int(SECONDS * run.sample_rate) if run.time_unit == "s" else SAMPLES)
    for name, other in ((run.output, "command"), ("command", run.output)):
        first, end = longest_rest(run.channels[name])
        # What moves only at the end of a rest, a step that ends it, is answered as soon as a machine can.
        moved = run.channels[other][first : end - min(least, (end - first) // 2)]
        if name == "command" and (run.kind != "blwn" or first == 0 or end == run.length):
            continue  # a command may rest, before and after a run in any case
        if end - first < least or np.ptp(moved) < MOVED * run.channels[other].std():
            continue
        if name == run.output and starts_again_from_rest(run.channels[name], end):
            continue
        text = message(
            "check.flat",
            channel=name,
            run=run.id,
            first=first,
            last=end - 1,
            duration=(end - first) / run.sample_rate,
            unit=run.time_unit,
            other=other,
        )
        yield Finding.of(run.id, "doubt", "flat", text)


def starts_again_from_rest(signal: Samples, end: int) -> bool:
    """Whether a signal goes on from where it stood: a machine at rest does, a sensor that was stuck jumps.

    A machine stands while its command stays in a dead zone, below friction, or away from its valve's neutral.
    """
    changes = np.abs(np.diff(signal))
    changes = changes[changes > 0]
    return end < len(signal) and abs(signal[end] - signal[end - 1]) <= USUAL * float(np.median(changes))


def longest_rest(signal: Samples) -> tuple[int, int]:
    """The longest part [first, end) of equal samples."""
    changes = np.flatnonzero(np.diff(signal) != 0) + 1
    edges = np.concatenate([[0], changes, [len(signal)]])
    longest = int(np.argmax(np.diff(edges)))
    return int(edges[longest]), int(edges[longest + 1])

"""A record that begins before its drive is on: the first step is answered far later than the steps after it."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np

from ident.checks.finding import Finding
from ident.matrix import Matrix
from ident.run import Run, Samples
from ident.words.message import message

STEP = 0.2  # of the command's range within all runs, which a step goes at least
MOVED = 0.1  # of the output's range, beyond which it has set out
REST = 8  # samples for which command and output rest before a step
LATE = 3.0  # times the latest answer to a later step
LEAST = 2  # later steps: one may be a slow one


def late_starts(matrix: Matrix) -> Iterator[Finding]:
    """A doubt of each run whose first step, in its first samples, is answered far later than other steps are."""
    runs = [run for run in matrix.runs if "command" in run.channels and run.output != "command"]
    for output in dict.fromkeys(run.output for run in runs):
        like = [run for run in runs if run.output == output]
        least = STEP * max(float(np.ptp(run.command)) for run in like)
        later = [seconds for run in like for seconds in _answers(run, least)]
        if len(later) < LEAST:
            continue
        for run in like:
            begin, wait = _first(run, least)
            if wait > max(REST, LATE * max(later) * run.sample_rate):
                values = {
                    "late": (wait / run.sample_rate, run.time_unit),
                    "usual": (max(later), run.time_unit),
                    "first": ((begin + wait) / run.sample_rate, run.time_unit),
                }
                said = message("check.late_start", run=run.id, output=output, count=len(later), **values)
                yield Finding.of(run.id, "doubt", "late-start", said)


def _answers(run: Run, least: float) -> Iterator[float]:
    """The times in s after which an output at rest sets out behind a step of so much, but for the first samples."""
    steps = [int(place) + 1 for place in np.flatnonzero(np.abs(np.diff(run.command)) >= least)]
    for step, after in itertools.pairwise([*steps, run.length]):
        rested = slice(step - REST, step)
        if step >= 2 * REST and np.ptp(run.command[rested]) < least / 2.0:
            wait = _wait(run, rested, step, after)
            if wait:
                yield wait / run.sample_rate


def _first(run: Run, least: float) -> tuple[int, int]:
    """The last step in the first samples, and how many samples the output then stands; 0 where it does not set out.

    What sets out as the command changes is no answer to the step: a machine that is held may stand for long.
    """
    changes = np.flatnonzero(np.abs(np.diff(run.command[:REST])) >= least) + 1
    begin = int(changes[-1]) if len(changes) else 0
    steady = np.abs(run.command[begin:] - run.command[begin]) <= MOVED / 2.0 * np.ptp(run.command)
    end = begin + (len(steady) if steady.all() else int(np.argmin(steady)))
    if abs(float(run.command[begin])) < least or end - begin <= REST:
        return begin, 0
    return begin, _wait(run, slice(begin, begin + REST), begin, end)


def _wait(run: Run, rested: slice, step: int, end: int) -> int:
    """The samples from a step until the output leaves where it rested; 0 where it did not rest, or stays."""
    y: Samples = run.measured
    middle, beyond = float(np.median(y[rested])), MOVED * float(np.ptp(y))
    if not beyond or np.any(np.abs(y[rested] - middle) > beyond):
        return 0
    away = np.abs(y[step:end] - middle) > beyond
    return int(np.argmax(away)) if away.any() else 0

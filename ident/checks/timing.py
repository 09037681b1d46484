"""Clock, gaps, and a sample rate that is too low for what was excited."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ident.checks.finding import Finding
from ident.checks.response import Response
from ident.readers.clock import STRAY
from ident.run import Run
from ident.words.message import message

JITTER = 0.5  # samples; a time printed with too few digits stays below, a real clock that errs more does not
SAMPLES_A_CYCLE = 10.0  # of the highest excited frequency; below, the command between samples decides the fit
POWER = 0.95
FEW = 0.01  # of the samples of a run: interpolated a tenth of the deviation off, so many leave 1 % of the deviation
QUICK, SETTLED = 2, 10  # samples behind a step: most of the answer, and all of it
MOST = 0.8  # of the answer
STEPS = 3  # at least, to tell it by


def timing(run: Run, response: Response | None) -> Iterator[Finding]:
    """Gaps and jitter of a time column; samples a cycle."""
    if run.gaps:
        first, end = run.unbroken or (0, run.length)
        key = "check.gaps_filled" if run.evened else "check.gaps"
        text = message(key, run=run.id, missing=run.gaps, first=first, end=end)
        harmless = run.evened and run.gaps <= FEW * run.length
        yield Finding.of(run.id, "note" if harmless else "doubt", "gaps", text)
    if run.evened and run.clock_jitter > STRAY:
        key = "check.jitter_held" if run.hold == "zoh" else "check.jitter_interpolated"
        text = message(key, run=run.id, jitter=run.clock_jitter, rate=run.sample_rate)
        yield Finding.of(run.id, "note", "clock-jitter", text)
    elif run.clock_jitter > STRAY:
        text = message("check.jitter", run=run.id, jitter=run.clock_jitter)
        yield Finding.of(run.id, "doubt" if run.clock_jitter > JITTER else "note", "clock-jitter", text)
    if response is None or run.time_unit != "s":
        return
    if run.hold == "zoh":  # between the samples it is known
        yield from _too_quick(run)
        return
    highest = response.below(POWER)
    if run.hold != "band-limited" and run.sample_rate < SAMPLES_A_CYCLE * highest:
        text = message(
            "check.few_samples",
            run=run.id,
            samples=run.sample_rate / highest,
            highest=highest,
            share=POWER,
            least=SAMPLES_A_CYCLE * highest,
        )
        yield Finding.of(run.id, "doubt", "sample-rate", text)


def _too_quick(run: Run) -> Iterator[Finding]:
    """A held command's steps that are answered within two samples: how the machine goes there is not recorded.

    Answered is what then stays: an answer that swings, or is seen without its sign, may be where it ends up after
    two samples by chance, and goes on.
    """
    size = np.abs(np.diff(run.command))
    steps = np.flatnonzero(size > 0.5 * np.std(run.command))
    alone = [k for k in steps if k + 1 + SETTLED < run.length and not size[k + 1 : k + 1 + SETTLED].any()]
    x = run.measured
    whole = np.array([x[k + 1 + SETTLED] - x[k] for k in alone])
    told = np.abs(whole) > 0.2 * np.std(x)
    if told.sum() < STEPS:
        return
    later = np.array([x[k + 1 + QUICK : k + 2 + SETTLED] - x[k] for k in alone])
    away = np.abs(later[told] / whole[told][:, None] - 1.0).max(axis=1)  # from where it ends up, at most
    share = 1.0 - float(np.median(away))
    if share > MOST:
        text = message("check.too_quick", run=run.id, share=share, samples=QUICK, least=4 * run.sample_rate)
        yield Finding.of(run.id, "doubt", "sample-rate", text)

"""Clock, gaps, and a sample rate that is too low for what was excited."""

from __future__ import annotations

from collections.abc import Iterator

from ident.checks.finding import Finding
from ident.checks.response import Response
from ident.matrix import Run

JITTER = 0.5  # samples; a time printed with too few digits stays below, a real clock that errs more does not
JITTER_TO_NAME = 0.1  # samples: 0.7 degrees of phase at 80 Hz and 4096 Hz
SAMPLES_A_CYCLE = 10.0  # of the highest excited frequency; below, the command between samples decides the fit
POWER = 0.95


def timing(run: Run, response: Response | None) -> Iterator[Finding]:
    """Gaps and jitter of a time column; samples a cycle."""
    if run.gaps:
        text = (
            f"the time of run {run.id} has gaps: {run.gaps} samples are missing; phases behind a gap are shifted, so "
            "use the longest part without one (rows) or repeat the run"
        )
        yield Finding(run.id, "doubt", "gaps", text)
    if run.clock_jitter > JITTER_TO_NAME:
        text = (
            f"the clock of run {run.id} strays by up to {run.clock_jitter:.2g} samples from an even one; "
            "samples are taken as even, so record with a hardware clock, or print the time with more digits"
        )
        yield Finding(run.id, "doubt" if run.clock_jitter > JITTER else "note", "clock-jitter", text)
    if response is None or run.time_unit != "s":
        return
    highest = response.below(POWER)
    if run.sample_rate < SAMPLES_A_CYCLE * highest:
        text = (
            f"run {run.id} has {run.sample_rate / highest:.2g} samples a cycle at {highest:.3g} Hz, below which "
            f"{POWER:.0%} of the command's power lies; sample at {SAMPLES_A_CYCLE * highest:.3g} Hz or more"
        )
        yield Finding(run.id, "doubt", "sample-rate", text)

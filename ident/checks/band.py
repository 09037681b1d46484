"""The band of band-limited white noise."""

from __future__ import annotations

from collections.abc import Iterator

from ident.checks.finding import Finding
from ident.checks.response import Response
from ident.run import Run
from ident.words.message import message

POWER = 0.95
LOWEST, HIGHEST = 60.0, 100.0  # Hz; white noise of 0-80 Hz has 95 % of its power below 76 Hz, filtered or not


def band(run: Run, response: Response | None) -> Iterator[Finding]:
    """A run of kind ``blwn`` whose command does not fill 0-80 Hz, or reaches beyond."""
    if run.kind != "blwn" or response is None or run.time_unit != "s":
        return
    edge = response.below(POWER)
    if LOWEST <= edge <= HIGHEST:
        return
    key = "check.band_narrow" if edge < LOWEST else "check.band_wide"
    yield Finding.of(run.id, "doubt", "band", message(key, run=run.id, share=POWER, edge=edge))

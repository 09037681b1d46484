"""The band of band-limited white noise."""

from __future__ import annotations

from collections.abc import Iterator

from ident.checks.finding import Finding
from ident.checks.response import Response
from ident.run import Run
from ident.words.run_name import run_name

POWER = 0.95
LOWEST, HIGHEST = 60.0, 100.0  # Hz; white noise of 0-80 Hz has 95 % of its power below 76 Hz, filtered or not


def band(run: Run, response: Response | None) -> Iterator[Finding]:
    """A run of kind ``blwn`` whose command does not fill 0-80 Hz, or reaches beyond."""
    if run.kind != "blwn" or response is None or run.time_unit != "s":
        return
    edge = response.below(POWER)
    if LOWEST <= edge <= HIGHEST:
        return
    follows = (
        "higher frequencies are not excited and not identifiable" if edge < LOWEST else "the model is made for 0-80 Hz"
    )
    text = (
        f"the command of {run_name(run.id)} is called blwn, but {POWER:.0%} of its power lies below {edge:.3g} Hz "
        f"instead of about 76 Hz; {follows}: check the generator, the sample rate and kind"
    )
    yield Finding(run.id, "doubt", "band", text)

"""A constant difference between command and displacement."""

from __future__ import annotations

from collections.abc import Iterator

from ident.checks.finding import Finding
from ident.checks.response import rests
from ident.run import Run
from ident.words.percent import percent
from ident.words.run_name import run_name

SMALL = 0.05  # of the displacement's standard deviation; as large as the error that a good model leaves
LARGE = 1.0


def offset(run: Run) -> Iterator[Finding]:
    """The difference of means over the standard deviation, to which eq. (17) is blind."""
    if run.output != "displacement" or run.units.get("command") != "m" or run.units.get("displacement") != "m":
        return
    if rests(run):  # the output may be on its way to the command, and its mean is that of the way
        return
    difference = float(run.measured.mean() - run.command.mean())
    share = abs(difference) / float(run.measured.std())
    if share <= SMALL:
        return
    side = "above" if difference > 0 else "below"
    remedy = (
        "Zero the sensor, or state the offset"
        if share > LARGE
        else "Possible causes: null bias, static load, sensor zero"
    )
    text = (
        f"the mean displacement of {run_name(run.id)} is {1e3 * abs(difference):.3g} mm {side} the command "
        f"({percent(share)} of its standard deviation). The error of eq. (17) ignores constant offsets. {remedy}"
    )
    yield Finding(run.id, "doubt" if share > LARGE else "note", "offset", text)

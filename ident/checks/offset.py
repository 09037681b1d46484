"""A constant difference between command and displacement."""

from __future__ import annotations

from collections.abc import Iterator

from ident.checks.finding import Finding
from ident.checks.response import rests
from ident.run import Run

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
    remedy = "zero the sensor or state offset" if share > LARGE else "a null bias, a static load or a sensor's zero"
    text = (
        f"displacement of run {run.id} lies {1e3 * difference:.3g} mm beside the command, {share:.2g} times its "
        f"standard deviation; the error of eq. (17) does not see it: {remedy}"
    )
    yield Finding(run.id, "doubt" if share > LARGE else "note", "offset", text)

"""A constant difference between command and displacement."""

from __future__ import annotations

from collections.abc import Iterator

from ident.checks.finding import Finding
from ident.checks.response import rests
from ident.run import Run
from ident.words.message import message

SMALL = 0.05  # of the displacement's standard deviation; as large as the error of a good model
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
    remedy = message("check.offset_large" if share > LARGE else "check.offset_small")
    values = {"run": run.id, "millimetres": 1e3 * abs(difference), "share": share, "remedy": remedy}
    text = message("check.offset_above" if difference > 0 else "check.offset_below", **values)
    yield Finding.of(run.id, "doubt" if share > LARGE else "note", "offset", text)

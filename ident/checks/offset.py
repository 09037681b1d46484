"""A constant difference between command and displacement."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ident.checks.finding import Finding
from ident.checks.response import rests
from ident.run import Run
from ident.words.message import message

SMALL = 0.05  # of the displacement's standard deviation; as large as the error of a good model
LARGE = 1.0
STRETCHES = 20  # of a record, whose means are compared


def offset(run: Run) -> Iterator[Finding]:
    """The difference of means at rest over the standard deviation, to which eq. (17) is blind."""
    if run.output != "displacement" or run.units.get("command") != "m" or run.units.get("displacement") != "m":
        return
    if rests(run):  # the output may be on its way to the command, and its mean is that of the way
        return
    difference = _constant(run)
    share = abs(difference) / float(run.measured.std())
    if share <= SMALL:
        return
    remedy = message("check.offset_large" if share > LARGE else "check.offset_small")
    values = {"run": run.id, "millimetres": 1e3 * abs(difference), "share": share, "remedy": remedy}
    text = message("check.offset_above" if difference > 0 else "check.offset_below", **values)
    yield Finding.of(run.id, "doubt" if share > LARGE else "note", "offset", text)


def _constant(run: Run) -> float:
    """The constant a of ȳ − r̄ = a − T (y₁ − y₀)/t, by least squares over stretches of length t.

    So much the means of command r and displacement y differ at rest. What follows by a lag, T y' + y = r + a, is behind
    its command on its way, as after a step, and that is no offset.
    """
    if run.length < STRETCHES:
        return float(run.measured.mean() - run.command.mean())
    command, shown = (np.array_split(signal, STRETCHES) for signal in (run.command, run.measured))
    difference = [y.mean() - r.mean() for r, y in zip(command, shown, strict=True)]
    terms = np.column_stack([np.ones(STRETCHES), [y[-1] - y[0] for y in shown]])
    return float(np.linalg.lstsq(terms, np.array(difference))[0][0])

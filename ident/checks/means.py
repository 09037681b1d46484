"""Forces whose means differ from run to run by more than they vary within one."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ident.checks.finding import Finding
from ident.matrix import Matrix
from ident.words.message import message

OUTPUTS = ("force", "load_pressure")
APART = 2.0
"""[standard deviations within a run] Of the means of the runs, from which on they are said. Why: no zero of a
transducer drifts so far. Test: tests/checks/test_means.py::test_means_are_said_from_twice_the_deviation_on"""


def means(matrix: Matrix) -> Iterator[Finding]:
    """A fit hardly counts the means of runs, unless it is known that the zero was not set for each run."""
    for name in OUTPUTS:
        runs = [run for run in matrix.runs if run.output == name and name not in run.zeroed]
        if len(runs) < 2:
            continue
        between = float(np.std([run.measured.mean() for run in runs]))
        within = float(np.mean([run.measured.std() for run in runs]))
        if within > 0 and between > APART * within:
            text = message("check.means", channel=name, ratio=between / within)
            yield Finding.of(None, "note", "means", text)

"""An output that is a copy of its command: one column taken for both."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ident.checks.finding import Finding
from ident.run import Run
from ident.words.message import message

EXACT = 1e-6
"""Share of the output's deviation that no gain and offset of the command explain: any recorder's noise is larger."""


def copied(run: Run) -> Iterator[Finding]:
    """A doubt where the output is a gain times the command, and an offset, without delay, dynamics or noise."""
    if "command" not in run.channels or run.stepped:
        return
    u, x = run.command - run.command.mean(), run.measured - run.measured.mean()
    residual = x - u * (float(u @ x) / float(u @ u))
    if not x.any() or float(np.std(residual)) > EXACT * float(np.std(x)):
        return
    yield Finding.of(run.id, "doubt", "copied", message("check.copied", channel=run.output, run=run.id))

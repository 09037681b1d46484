"""The neutral of a command: what it is held at while a machine that integrates it stands still."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ident.chain.chain import Chain, integrates
from ident.matrix import Matrix
from ident.words.engineering import with_unit

_FELT = 1e-3  # of the command's standard deviation


def from_neutral(matrix: Matrix, chain: Chain) -> Matrix:
    """The matrix with commands counted from their neutral, where the chain integrates them.

    A null bias, a dead zone that is not in the middle and a recorder's zero are one thing there, and any of them makes
    the model run away. One machine has one neutral: the middle one of the runs to fit that show it.
    """
    shown = [run.command[0] for run in matrix.of_use("fit") or matrix.runs if run.stands]
    neutral = float(np.median(shown)) if shown else 0.0
    felt = neutral and abs(neutral) > _FELT * max(run.drive for run in matrix.runs)
    if not felt or not integrates(chain, matrix.runs, matrix.actuator):
        return matrix
    text = with_unit(f"{neutral:.4g}", matrix.runs[0].units.get("command", "1"))
    said = (
        f"The command is counted from {text}, at which it is held first while the output stands: that is the neutral "
        f"of a machine that integrates it."
    )
    runs = tuple(replace(run, channels={**run.channels, "command": run.command - neutral}) for run in matrix.runs)
    return replace(matrix, runs=runs, notices=(said, *matrix.notices))

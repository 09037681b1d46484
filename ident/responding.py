"""Runs whose output does next to nothing: eq. (17), which divides by what it does, says nothing of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ident.run import BENCH, STILL, Run
from ident.words.percent import percent

_STILL = 0.02  # of the typical standard deviation of the output
_DRIVEN = 0.1  # of the typical size of the command: as much asks for an answer


def still_apart(runs: Sequence[Run]) -> tuple[tuple[Run, ...], tuple[str, ...]]:
    """The runs, those that stand still of use "still", which is neither fitted nor verified; and what is said of them.

    A run stands still whose output has less than 2 % of the standard deviation that it has in the others (their upper
    quartile) under more than 10 % of the median command: what acts against the motion holds the machine there. Only
    beside runs that move and fit.
    """
    found, said = {run.id: run for run in runs}, []
    for name in dict.fromkeys(run.output for run in runs):
        alike = [run for run in runs if run.output == name and run.kind not in BENCH and "command" in run.channels]
        if not alike:
            continue
        moved = float(np.quantile([_moved(run) for run in alike], 0.75))
        driven = float(np.median([run.drive for run in alike]))
        still = [run for run in alike if _moved(run) < _STILL * moved and run.drive > _DRIVEN * driven]
        if not any(run.use == "fit" for run in alike if run not in still):
            continue
        found |= {run.id: replace(run, use=STILL) for run in still}
        said += [_said(run, _moved(run) / moved) for run in still]
    return tuple(found.values()), tuple(said)


def _moved(run: Run) -> float:
    return float(np.std(run.measured))


def _said(run: Run, share: float) -> str:
    return (
        f"run {run.id} stands still: its {run.output} has {percent(share)} of the deviation that the other runs have, "
        "though its command is of the size of theirs, as behind a dead zone, in dry friction or at a stop; the error "
        "of eq. (17), which divides by that deviation, says nothing of it, so it is neither fitted nor verified"
    )

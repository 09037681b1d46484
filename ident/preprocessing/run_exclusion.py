"""Runs whose output does next to nothing: eq. (17), which divides by what it does, says nothing of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ident.preprocessing.step import Prepared, Step, Threshold
from ident.run import BENCH, STILL, Run
from ident.words.percent import percent
from ident.words.run_name import run_name

STANDS = Threshold(
    0.02,
    "of the upper quartile of the runs' standard deviations of the output",
    "a run whose output deviates less stands still",
    "noise is of that size on a usual record, so that the error of such a run would be one of noise over noise",
)
DRIVEN = Threshold(
    0.1,
    "of the median of the runs' commands",
    "a run whose command is larger asks for an answer",
    "a run with a smaller command was meant to be small, and is fitted",
)


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
        still = [run for run in alike if _moved(run) < STANDS.value * moved and run.drive > DRIVEN.value * driven]
        if not any(run.use == "fit" for run in alike if run not in still):
            continue
        found |= {run.id: replace(run, use=STILL) for run in still}
        said += [_said(run, _moved(run) / moved) for run in still]
    return tuple(found.values()), tuple(said)


def _moved(run: Run) -> float:
    return float(np.std(run.measured))


def _said(run: Run, share: float) -> str:
    return (
        f"{run_name(run.id)} stands still: its {run.output} has {percent(share)} of the deviation that the other runs "
        "have, though its command is of the size of theirs, as behind a dead zone, in dry friction or at a stop; the "
        "error of eq. (17), which divides by that deviation, says nothing of it, so it is neither fitted nor verified"
    )


def _act(prepared: Prepared) -> tuple[Prepared, tuple[str, ...]]:
    """Take the runs that stand still out of the fit and of the verification."""
    runs, said = still_apart(prepared.matrix.runs)
    return replace(prepared, matrix=replace(prepared.matrix, runs=runs)), said


RUN_EXCLUSION = Step(
    name="run_exclusion",
    does="takes runs that do not respond out of the fit and of the verification",
    applies="the output of a run does next to nothing under a command that moves the machine in other runs",
    without="every run is fitted or verified as it is stated",
    thresholds=(STANDS, DRIVEN),
    act=_act,
    needs_model=False,
)

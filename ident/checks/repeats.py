"""The same samples under two names, and the same conditions measured twice."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from itertools import groupby

from ident.checks.finding import Finding
from ident.matrix import Matrix, Run


def repeats(matrix: Matrix) -> Iterator[Finding]:
    """Duplicates are faults where they verify what they fitted, else doubts; repeats are notes."""
    for runs in alike(matrix, samples_of):
        uses = {run.use for run in runs}
        told = "a verification by the data of the fit proves nothing" if len(uses) > 1 else "they count twice in a fit"
        text = f"runs {names(runs)} hold the same samples: {told}; keep one of them or correct file, rows or columns"
        for run in runs[1:]:
            yield Finding(run.id, "fault" if len(uses) > 1 else "doubt", "duplicate-run", text)
    for runs in alike(matrix, conditions_of):
        if len({samples_of(run) for run in runs}) == len(runs):
            text = (
                f"runs {names(runs)} repeat the same conditions: their difference shows what repeats and what is noise"
            )
            yield Finding(None, "note", "repeat", text)


def alike(matrix: Matrix, key: Callable[[Run], object]) -> Iterator[list[Run]]:
    """Groups of two runs or more with one key; a key of None belongs to no group."""
    keyed = [(repr(key(run)), run) for run in matrix.runs if key(run) is not None]
    for _, group in groupby(sorted(keyed, key=lambda pair: pair[0]), key=lambda pair: pair[0]):
        runs = [run for _, run in group]
        if len(runs) > 1:
            yield runs


def samples_of(run: Run) -> str:
    """A fingerprint of the output's samples: two measurements never agree in every bit."""
    return hashlib.sha256(run.measured.tobytes()).hexdigest()


def conditions_of(run: Run) -> tuple[object, ...] | None:
    """What was set for a run; None where nothing is stated that would tell it apart."""
    if run.specimen is None and run.gain is None and run.amplitude is None:
        return None
    stated = (run.specimen, run.gain, run.amplitude, run.kind, run.use, run.frequency, run.position_range)
    return (*stated, run.output)


def names(runs: list[Run]) -> str:
    """Their ids in words."""
    return " and ".join([", ".join(run.id for run in runs[:-1]), runs[-1].id])

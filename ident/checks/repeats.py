"""The same samples under two names, and one measurement repeated."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from itertools import groupby

from ident.checks.finding import Finding
from ident.matrix import Matrix
from ident.noise.repeats import groups, repeated, unlabelled
from ident.run import Run
from ident.words.message import Message, message


def repeats(matrix: Matrix) -> Iterator[Finding]:
    """Duplicates are faults where they verify what they fitted, else doubts; repeats are notes."""
    for runs in duplicates(matrix):
        shared = len({run.use for run in runs}) == 1
        text = message("check.duplicate" if shared else "check.duplicate_verify", runs=[run.id for run in runs])
        for run in runs[1:]:
            yield Finding.of(run.id, "doubt" if shared else "fault", "duplicate-run", text)
    by_id = {run.id: run for run in matrix.runs}
    for group in groups(repeated(matrix.runs)):
        yield Finding.of(None, "note", "repeat", _repeat(group, labelled=not unlabelled(by_id[next(iter(group))])))


def _repeat(group: dict[str, int], *, labelled: bool) -> Message:
    """Runs that repeat each other, with the samples by which the records of some begin apart from the first one's."""
    shifts = [
        message("shift.earlier" if shift > 0 else "shift.later", run=run, samples=abs(shift))
        for run, shift in group.items()
        if shift
    ]
    values = {"runs": list(group)} | ({"first": next(iter(group)), "shifts": shifts} if shifts else {})
    if shifts:
        return message("check.repeat_shifted" if labelled else "check.repeat_unlabelled_shifted", **values)
    return message("check.repeat" if labelled else "check.repeat_unlabelled", **values)


def duplicates(matrix: Matrix) -> Iterator[list[Run]]:
    """Groups of two runs or more that hold the same samples."""
    keyed = sorted(((samples_of(run), run) for run in matrix.runs), key=lambda pair: pair[0])
    for _, group in groupby(keyed, key=lambda pair: pair[0]):
        runs = [run for _, run in group]
        if len(runs) > 1:
            yield runs


def samples_of(run: Run) -> str:
    """A fingerprint of the output's samples: two measurements never agree in every bit."""
    return hashlib.sha256(run.measured.tobytes()).hexdigest()

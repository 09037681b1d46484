"""The same samples under two names, and one measurement repeated."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from itertools import groupby

from ident.checks.finding import Finding
from ident.matrix import Matrix
from ident.noise.repeats import groups, repeated, unlabelled
from ident.run import Run


def repeats(matrix: Matrix) -> Iterator[Finding]:
    """Duplicates are faults where they verify what they fitted, else doubts; repeats are notes."""
    for runs in duplicates(matrix):
        uses = {run.use for run in runs}
        told = "the validation is not independent" if len(uses) > 1 else "they count twice in a fit"
        text = (
            f"runs {names([run.id for run in runs])} contain the same samples: {told}. Keep one of them, or correct "
            "file, rows or columns"
        )
        for run in runs[1:]:
            yield Finding(run.id, "fault" if len(uses) > 1 else "doubt", "duplicate-run", text)
    by_id = {run.id: run for run in matrix.runs}
    for group in groups(repeated(matrix.runs)):
        if unlabelled(by_id[next(iter(group))]):
            text = (
                f"runs {names(list(group))} have the same command, and no label separates them. Their difference is "
                "used to estimate the noise. If a condition was changed, state it: specimen, gain, amplitude"
            )
        else:
            text = (
                f"runs {names(list(group))} repeat the same command under the same conditions. Their difference is "
                "used to estimate the noise"
            )
        yield Finding(None, "note", "repeat", text + shifts(group))


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


def shifts(group: dict[str, int]) -> str:
    """By how many samples the records of runs that repeat each other start apart, in words; nothing where none does."""
    first = next(iter(group))
    found = [
        f"{run} starts {abs(shift)} {'sample' if abs(shift) == 1 else 'samples'} {'earlier' if shift > 0 else 'later'}"
        for run, shift in group.items()
        if shift
    ]
    return f"; {names(found)} than {first}; the shift is removed before they are compared" if found else ""


def names(words: list[str]) -> str:
    """A list in words."""
    return " and ".join([", ".join(words[:-1]), words[-1]]) if len(words) > 1 else words[0]

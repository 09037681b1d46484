"""The same samples under two names, and the same conditions measured twice."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Iterator
from itertools import groupby

from ident.checks.finding import Finding
from ident.matrix import Matrix, Run
from ident.noise.floor import repeated


def repeats(matrix: Matrix) -> Iterator[Finding]:
    """Duplicates are faults where they verify what they fitted, else doubts; repeats are notes."""
    for runs in alike(matrix, samples_of):
        uses = {run.use for run in runs}
        told = "a verification by the data of the fit proves nothing" if len(uses) > 1 else "they count twice in a fit"
        text = f"runs {names(runs)} hold the same samples: {told}; keep one of them or correct file, rows or columns"
        for run in runs[1:]:
            yield Finding(run.id, "fault" if len(uses) > 1 else "doubt", "duplicate-run", text)
    bare = [run for run in matrix.runs if conditions_of(run) is None]
    for runs in together(repeated(bare)):
        text = (
            f"runs {names(runs)} have one command, and nothing stated tells them apart: what differs between them "
            "counts as noise; where something was changed, state it: specimen, gain, a channel"
        )
        yield Finding(None, "note", "repeat", text)
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


def together(pairs: Iterable[tuple[Run, Run]]) -> Iterator[list[Run]]:
    """The pairs as groups: each run in one, in the order in which they come."""
    groups: list[dict[str, Run]] = []
    for pair in pairs:
        group = next((group for group in groups if any(run.id in group for run in pair)), None)
        if group is None:
            groups.append(group := {})
        group |= {run.id: run for run in pair}
    yield from (list(group.values()) for group in groups)


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

"""A stored matrix as the page shows it: findings grouped by run, and the table of runs."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from app.pages.run_view import Conditions, conditions
from ident.words.number import plain
from ident.words.run_name import without_name
from ident.words.severity import levels
from ident.words.titles import title
from schemas.matrix import FindingView, MatrixView

_WORST = ("fault", "doubt", "note")


@dataclass(frozen=True)
class RunRow:
    """A run with its findings, the worst first, and the worst severity among them ("" for none)."""

    run: Conditions
    worst: str
    findings: tuple[FindingView, ...]


@dataclass(frozen=True)
class Flag:
    """One kind of fault or doubt: its words of the first run that has it, where that run stands, and how many more."""

    severity: str
    text: str
    run: str
    place: int
    others: int


@dataclass(frozen=True)
class MatrixPageView:
    """What the matrix page shows: `general` findings and `remarks` are of no single run, `flags` of some."""

    id: str
    serial: str
    parent: str | None
    summary: str
    facts: tuple[tuple[str, str], ...]
    general: tuple[FindingView, ...]
    flags: tuple[Flag, ...]
    remarks: tuple[FindingView, ...]
    notices: tuple[str, ...]
    runs: tuple[RunRow, ...]
    removed: str | None


def matrix_view(matrix: MatrixView) -> MatrixPageView:
    """The page of a matrix."""
    found = {run.id: [entry for entry in matrix.findings if entry.run == run.id] for run in matrix.runs}
    runs = tuple(_row(conditions(run), found[run.id]) for run in matrix.runs)
    general = [entry for entry in matrix.findings if entry.run not in found]
    return MatrixPageView(
        id=matrix.id,
        serial=matrix.serial,
        parent=matrix.parent,
        removed=matrix.removed_at,
        summary=_summary(matrix),
        facts=_facts(matrix),
        general=tuple(entry for entry in general if entry.severity != "note"),
        flags=_flags(runs),
        remarks=tuple(entry for entry in general if entry.severity == "note"),
        notices=tuple(matrix.notices),
        runs=runs,
    )


def counted(findings: list[FindingView] | tuple[FindingView, ...]) -> str:
    """ "1 error, 2 warnings", the worst first; "" for none."""
    return levels([entry.severity for entry in findings])


def _flags(runs: tuple[RunRow, ...]) -> tuple[Flag, ...]:
    """Each kind of fault or doubt once, the worst first."""
    kinds: dict[tuple[str, str], list[tuple[int, str, str]]] = {}
    for place, row in enumerate(runs):
        for entry in row.findings:
            if entry.severity != "note":
                kinds.setdefault((entry.severity, entry.code), []).append((place, row.run.id, entry.text))
    flags = [
        Flag(severity, text, run, place, len({each[0] for each in found}) - 1)
        for (severity, _), found in kinds.items()
        for place, run, text in found[:1]
    ]
    return tuple(sorted(flags, key=lambda flag: _WORST.index(flag.severity)))


def _row(run: Conditions, findings: list[FindingView]) -> RunRow:
    """The words of a finding stand beside the run, which they need not name again."""
    ordered = sorted(findings, key=lambda entry: _WORST.index(entry.severity))
    beside = tuple(entry.model_copy(update={"text": without_name(entry.text, run.id)}) for entry in ordered)
    return RunRow(run, ordered[0].severity if ordered else "", beside)


def _summary(matrix: MatrixView) -> str:
    uses = Counter(run.use for run in matrix.runs)
    seconds = sum(run.duration for run in matrix.runs)
    clock = "s" if all(run.time_unit == "s" for run in matrix.runs) else "samples"
    runs = "run" if len(matrix.runs) == 1 else "runs"
    return (
        f"{len(matrix.runs)} {runs}: {uses['fit']} for estimation, {uses['verify']} for validation; "
        f"{plain(seconds, 3)} {clock} in all; {counted(matrix.findings) or 'no findings'}"
    )


def _facts(matrix: MatrixView) -> tuple[tuple[str, str], ...]:
    channels = dict.fromkeys(name for run in matrix.runs for name in run.channels)
    return (
        ("Channels", ", ".join(map(title, channels))),
        ("SHA-256", matrix.data_hash),
    )

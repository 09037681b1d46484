"""A stored matrix as the page shows it: findings grouped by run, and the table of runs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

from app.pages import numbers
from app.pages.run_view import Conditions, conditions
from schemas.matrix import FindingView, MatrixView

_WORST = ("fault", "doubt", "note")


@dataclass(frozen=True)
class RunRow:
    """A run with the worst severity among its findings ("" for none) and their count in words."""

    run: Conditions
    worst: str
    findings: str


@dataclass(frozen=True)
class MatrixPageView:
    """What the matrix page shows."""

    id: str
    serial: str
    summary: str
    facts: tuple[tuple[str, str], ...]
    general: tuple[FindingView, ...]
    flagged: tuple[tuple[str, tuple[FindingView, ...]], ...]
    remarks: tuple[FindingView, ...]
    notices: tuple[str, ...]
    runs: tuple[RunRow, ...]


def matrix_view(matrix: MatrixView) -> MatrixPageView:
    """The page of a matrix."""
    flagged = {run.id: tuple(entry for entry in matrix.findings if entry.run == run.id) for run in matrix.runs}
    return MatrixPageView(
        id=matrix.id,
        serial=matrix.serial,
        summary=_summary(matrix),
        facts=_facts(matrix),
        general=tuple(entry for entry in matrix.findings if entry.run not in flagged and entry.severity != "note"),
        flagged=_by_weight(flagged),
        remarks=tuple(entry for entry in matrix.findings if entry.severity == "note"),
        notices=tuple(matrix.notices),
        runs=tuple(_row(conditions(run), flagged[run.id]) for run in matrix.runs),
    )


def counted(findings: list[FindingView] | tuple[FindingView, ...]) -> str:
    """ "1 fault, 2 doubts", the worst first; "" for none."""
    counts = Counter(entry.severity for entry in findings)
    return ", ".join(f"{counts[name]} {name}{'s' if counts[name] > 1 else ''}" for name in _WORST if counts[name])


def _by_weight(found: Mapping[str, tuple[FindingView, ...]]) -> tuple[tuple[str, tuple[FindingView, ...]], ...]:
    """Faults and doubts by run, the runs with the worst first; notes stand apart."""
    serious = {run: tuple(entry for entry in entries if entry.severity != "note") for run, entries in found.items()}
    listed = [(run, entries) for run, entries in serious.items() if entries]
    return tuple(sorted(listed, key=lambda pair: min(_WORST.index(entry.severity) for entry in pair[1])))


def _row(run: Conditions, findings: tuple[FindingView, ...]) -> RunRow:
    worst = next((name for name in _WORST if any(entry.severity == name for entry in findings)), "")
    return RunRow(run, worst, counted(findings))


def _summary(matrix: MatrixView) -> str:
    uses = Counter(run.use for run in matrix.runs)
    seconds = sum(run.duration for run in matrix.runs)
    runs = "run" if len(matrix.runs) == 1 else "runs"
    return (
        f"{len(matrix.runs)} {runs}: {uses['fit']} to fit, {uses['verify']} to verify; "
        f"{numbers.plain(seconds, 3)} s in all; {counted(matrix.findings) or 'no findings'}"
    )


def _facts(matrix: MatrixView) -> tuple[tuple[str, str], ...]:
    channels = dict.fromkeys(name for run in matrix.runs for name in run.channels)
    facts = [("Channels", ", ".join(name.replace("_", " ") for name in channels))]
    if matrix.parent:
        facts.append(("Revision of", matrix.parent))
    return (*facts, ("SHA-256", matrix.data_hash))

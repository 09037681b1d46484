"""A diagnosis as tables for a reader."""

from __future__ import annotations

from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING

from app.cli.tables import output, show

if TYPE_CHECKING:
    from ident.diagnosis.result import Diagnosis


def show_diagnosis(found: Diagnosis, matrix: Path, file: Path | None, seconds: float | None = None) -> None:
    """Print a diagnosis: errors, ranking, ladder, suspects, verdict, and the commands that come next, as they are run.

    `file` is where its JSON was written, None where it can be read nowhere again; `seconds` is the time limit.
    """
    from ident.diagnosis.next_commands import next_commands

    show(found.listings())
    console = output()
    if found.proposals:
        from ident.diagnosis.sentences import proposed_text

        console.print(proposed_text(found.proposals), markup=False)
    if file is not None:
        for command in next_commands(found, quote(str(file)), quote(str(matrix)), seconds):
            console.print(command, markup=False)
    console.print(f"seed {found.seed}: {found.seconds:.2f} s")

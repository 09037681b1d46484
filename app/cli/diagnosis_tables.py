"""A diagnosis as tables for a reader."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.cli.tables import output, show

if TYPE_CHECKING:
    from ident.diagnosis.result import Diagnosis


def show_diagnosis(found: Diagnosis, file: str = "D.json") -> None:
    """Print a diagnosis: errors, ranking, ladder, suspects, verdict, and the command that comes next.

    `file` is where its JSON was written.
    """
    from ident.diagnosis.recommended import next_command, next_run_command

    show(found.listings())
    console = output()
    if found.proposals:
        from ident.diagnosis.sentences import proposed_text

        console.print(proposed_text(found.proposals), markup=False)
    if command := next_command(found, file):
        console.print(command, markup=False)
    if run := next_run_command(found, file):
        console.print(run, markup=False)
    console.print(f"seed {found.seed}: {found.seconds:.2f} s")

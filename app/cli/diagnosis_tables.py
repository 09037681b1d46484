"""A diagnosis as tables for a reader."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.cli.tables import output, show

if TYPE_CHECKING:
    from ident.diagnosis.result import Diagnosis


def show_diagnosis(found: Diagnosis) -> None:
    """Print a diagnosis: errors, ranking, ladder, suspects, verdict."""
    show(found.listings())
    console = output()
    if found.proposals:
        from ident.diagnosis.words import proposed_text

        beside = " and what they stand beside" if found.proposals[-1].beside else ""
        console.print(f"`servoident fit MATRIX --custom D.json` adds the terms{beside}, with --terms N the first N of "
                      "them, D.json what --json wrote", markup=False)  # fmt: skip
        console.print(proposed_text(found.proposals), markup=False)
    console.print(f"seed {found.seed}: {found.seconds:.2f} s")

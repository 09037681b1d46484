"""The report as PDF: the same pieces, set by Typst, with its own fonts and the figures as drawings."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

from app.report.blocks import Block, Figure, Report, Table, Tables
from app.report.content import content
from app.report.sheet import NOTHING_STATED, Sheet
from ident.diagnosis.result import Diagnosis
from ident.figures import render
from ident.fit.result import FitResult
from ident.matrix import Matrix

TEMPLATE = Path(__file__).parent / "templates" / "report.typ"
_LONG = 24  # characters from which a column of text takes what width is left


def paper(matrix: Matrix, fit: FitResult, diagnosis: Diagnosis | None = None, sheet: Sheet = NOTHING_STATED) -> bytes:
    """The PDF, the same bytes for the same fit. Raises Unusable where the fit is of another model's data."""
    return typeset(content(matrix, fit, diagnosis, sheet))


def typeset(report: Report) -> bytes:
    """Set a report. What it says is data to the template, never Typst's own markup."""
    import typst  # noqa: PLC0415  slow to import, and seldom wanted

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        blocks = [_piece(block, folder) for block in report.blocks]
        told: dict[str, object] = {"title": report.title, "lead": report.lead, "blocks": blocks, "logo": None}
        if report.logo:
            told["logo"] = f"logo.{report.logo.ending}"
            (folder / f"logo.{report.logo.ending}").write_bytes(report.logo.content)
        (folder / "report.json").write_text(json.dumps(told, ensure_ascii=False), encoding="utf-8")
        (folder / "report.typ").write_bytes(TEMPLATE.read_bytes())
        return typst.compile(folder / "report.typ", root=folder, format="pdf", timestamp=0)


def _piece(block: Block, folder: Path) -> dict[str, Any]:
    """A block as plain data; a chart goes into a file of its own."""
    match block:
        case Figure():
            return {"kind": block.kind, "caption": block.caption, **_drawn(block, folder)}
        case Table():
            return _table(block)
        case Tables():
            return {"kind": block.kind, "tables": [_table(each) for each in block.tables]}
        case _:
            return asdict(block)


def _drawn(figure: Figure, folder: Path) -> dict[str, str | None]:
    if isinstance(figure.chart, str):
        return {"file": None, "says": figure.chart}
    (folder / f"{figure.name}.pdf").write_bytes(render(figure.chart, "pdf"))
    return {"file": f"{figure.name}.pdf", "says": ""}


def _table(block: Table) -> dict[str, Any]:
    rows = [[str(cell) for cell in row] for row in block.rows]
    return {
        "kind": block.kind,
        "header": block.header,
        "rows": rows,
        "numbers": block.numbers,
        "marked": block.marked,
        "wide": list(_wide(block, rows)),
    }


def _wide(block: Table, rows: list[list[str]]) -> Iterator[int]:
    for place in range(len(block.header)):
        if place not in block.numbers and any(len(row[place]) > _LONG for row in rows):
            yield place

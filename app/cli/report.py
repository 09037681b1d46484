"""`servoident report`: everything about a fit in one file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.given import read_diagnosis, read_fit
from app.cli.output import check_target, write_bytes
from ident.errors import Unusable


def report(
    matrix: Annotated[Path, typer.Argument(metavar="MATRIX", help="Data set: a folder, its matrix.yaml, or a .zip.")],
    out: Annotated[Path, typer.Option(metavar="FILE", help="The report, an .html or .pdf file.")],
    fit: Annotated[
        Path | None, typer.Option(metavar="FIT.json", help="Fit. Default: make a fit with default settings.")
    ] = None,
    diagnosis: Annotated[
        Path | None, typer.Option(metavar="D.json", help="File from `servoident diagnose --json`.")
    ] = None,
) -> None:
    """Write an HTML or PDF report.

    It holds data, errors, parameters, figures and diagnosis in one file that opens without a network.
    """
    if out.suffix.lower() not in (".html", ".htm", ".pdf"):
        raise Unusable(
            "unknown-format", f"no report as {out.suffix or out.name!r}", "--out", "name a file in .html or .pdf"
        )
    check_target(out)
    result = None if fit is None else read_fit(fit)
    from app.cli.progress import shown
    from app.report.document import document
    from ident.fit.settings import Settings
    from ident.readers import read_matrix
    from ident.workflows import identify

    found = None if diagnosis is None else read_diagnosis(diagnosis)
    read = read_matrix(matrix)
    if result is None:
        with shown() as progress:
            result = identify(read, Settings(), progress)
    if out.suffix.lower() == ".pdf":
        from app.report.paper import paper

        write_bytes(paper(read, result, found), out)
    else:
        write_bytes(document(read, result, found).encode(), out)
    print(f"wrote {out}")

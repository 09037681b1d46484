"""`servoident report`: everything about a fit in one file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.input_files import read_diagnosis, read_fit
from app.cli.last_diagnosis import found_file
from app.cli.output import check_target, write_bytes
from app.cli.report_options import Customer, Laboratory, Logo, OilTemperature, Operator, Order, TestDate
from ident.errors import Unusable

if TYPE_CHECKING:
    from app.report.sheet import Sheet
    from ident.diagnosis.result import Diagnosis
    from ident.fit.result import FitResult
    from ident.matrix import Matrix

_ENDINGS = (".html", ".htm", ".pdf", ".xlsx", ".zip")


def report(
    matrix: Annotated[Path, typer.Argument(metavar="MATRIX", help="Data set: a folder, its matrix.yaml, or a .zip.")],
    out: Annotated[
        Path, typer.Option(metavar="FILE", help="The report, an .html or .pdf file; tables: .xlsx or .zip.")
    ],
    fit: Annotated[
        Path | None, typer.Option(metavar="FIT.json", help="Fit. Default: make a fit with default settings.")
    ] = None,
    diagnosis: Annotated[
        Path | None,
        typer.Option(metavar="D.json|last", help="File from `servoident diagnose --json`, or last: the latest kept."),
    ] = None,
    laboratory: Laboratory = "",
    customer: Customer = "",
    order: Order = "",
    operator: Operator = "",
    date: TestDate = "",
    oil_temperature: OilTemperature = "",
    logo: Logo = None,
) -> None:
    """Write an HTML or PDF report, or the tables for a spreadsheet.

    The report holds data, errors, parameters, figures and diagnosis in one file that opens without a network. It begins
    with a data sheet and ends with lines to be signed. An .xlsx file has a sheet for each table, a .zip a CSV file.
    """
    ending = out.suffix.lower()
    if ending not in _ENDINGS:
        what, remedy = f"no report as {out.suffix or out.name!r}", f"name a file in {', '.join(_ENDINGS)}"
        raise Unusable("unknown-format", what, "--out", remedy)
    check_target(out)
    result = None if fit is None else read_fit(fit)
    from app.cli.progress import shown
    from app.report.sheet import Sheet
    from app.report.sheet import logo as picture
    from ident.fit.settings import Settings
    from ident.readers import read_matrix
    from ident.workflows import identify

    stated = {
        "laboratory": laboratory,
        "customer": customer,
        "order": order,
        "operator": operator,
        "date": date,
        "oil_temperature": oil_temperature,
    }
    sheet = Sheet(logo=picture(logo) if logo else None).of(stated)
    read = read_matrix(matrix)
    found = None if diagnosis is None else read_diagnosis(found_file(diagnosis, read))
    if result is None:
        with shown() as progress:
            result = identify(read, Settings(), progress)
    write_bytes(_written(ending, read, result, found, sheet), out)
    print(f"wrote {out}")


def _written(ending: str, matrix: Matrix, fit: FitResult, found: Diagnosis | None, sheet: Sheet) -> bytes:
    if ending in (".xlsx", ".zip"):
        from app.report.tables import tables
        from app.report.workbook import as_xlsx, as_zip

        return (as_xlsx if ending == ".xlsx" else as_zip)(tables(matrix, fit, found))
    if ending == ".pdf":
        from app.report.paper import paper

        return paper(matrix, fit, found, sheet)
    from app.report.document import document

    return document(matrix, fit, found, sheet).encode()

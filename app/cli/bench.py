"""`servoident bench`: Kononykhin's procedures on bench records, and the acceptance sheet."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.output import STANDARD_OUTPUT, check_target, write_bytes, write_json


def bench(
    matrix: Annotated[Path, typer.Argument(metavar="MATRIX", help="Data set: a folder, its matrix.yaml, or a .zip.")],
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write all results as JSON; - is stdout.")] = None,
    out: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the acceptance sheet as PDF.")] = None,
    identification: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", help="Write the identification as C header, for a control unit with this program."
        ),
    ] = None,
) -> None:
    """Analyse static, frequency and speed bench records.

    Exit status 1 if a limit of the data set is violated.
    """
    from app.cli.tables import show
    from ident.bench.acceptance import passed, read_limits, sheet
    from ident.bench.analysis import analyse
    from ident.bench.records import bench_set
    from ident.bench.report import to_json
    from ident.bench.tables import with_sheet
    from ident.readers import read_matrix

    check_target(json)
    check_target(out)
    check_target(identification)
    read = read_matrix(matrix)
    limits = read_limits(read.limits_text, read.limits or "limits")
    records = bench_set(read)
    analysis = analyse(records)
    lines = sheet(analysis, limits)
    if json is not None:
        write_json(to_json(read, records, analysis, lines), json)
    if out is not None:
        from ident.figures import render
        from ident.figures.acceptance_sheet import acceptance_sheet

        write_bytes(render(acceptance_sheet(read, records, analysis, lines), "pdf"), out)
    if json != STANDARD_OUTPUT:
        show(with_sheet(analysis, lines))
    analysis.complete()
    if identification is not None:
        from ident.export import as_identification

        write_bytes(as_identification(analysis).encode(), identification)
        if json != STANDARD_OUTPUT:
            print(f"wrote {identification}: the identification of a set of {len(records.records)} records")
    if not passed(lines):
        raise typer.Exit(1)

"""`servoident sheet`: the acceptance sheet of a stored fit, as the production line judges it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.remote import DEFAULT, Server, Token, request, segment


def sheet(
    fit: Annotated[str, typer.Argument(metavar="FIT", help="Id of a stored fit of bench records.")],
    server: Server = DEFAULT,
    token: Token = "",
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the sheet as JSON; - is stdout.")] = None,
) -> None:
    """Show the acceptance sheet of a stored fit against the limits.

    Limits are those of the production line, else those of the data set. Exit status 1 unless it passes or has no
    limits.
    """
    from app.cli.tables import output, table
    from ident.bench.acceptance import Line
    from ident.bench.tables import sheet_rows

    check_target(json)
    found = request(server, token, "GET", f"/fits/{segment(fit)}/sheet").json()
    if json is not None:
        write_json(found, json)
    if json != STANDARD_OUTPUT:
        lines = [
            Line(
                one["name"],
                one["meaning"],
                one["value"],
                one["std_error"],
                one["unit"],
                one["lower"],
                one["upper"],
                one["outcome"],
            )
            for one in found["lines"]
        ]
        numbers = ("value", "std error", "min", "max")
        output().print(table(("quantity", "value", "std error", "unit", "min", "max", ""), sheet_rows(lines), numbers))
        print(f"{found['serial']}: {found['verdict'] or 'no limits'}")
    if found["verdict"] not in (None, "pass"):
        raise typer.Exit(1)

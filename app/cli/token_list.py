"""`servoident token list`: who may use the service."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.data_options import Data, Database
from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.records import records


def list_(
    data: Data = None,
    database: Database = "",
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the list as JSON; - is stdout.")] = None,
) -> None:
    """List tokens with role, state and last use, including expired ones."""
    from app.access import service
    from app.cli.tables import output, table
    from app.paging import every

    check_target(json)
    with records(data, database) as found:
        tokens = list(every(lambda cursor: service.listed(found, cursor, 1000)))
    if json is not None:
        write_json([one.model_dump() for one in tokens], json)
    if json == STANDARD_OUTPUT:
        return
    if not tokens:
        print("there are no tokens: servoident token new --role ROLE --name NAME")
        return
    header = ("id", "name", "role", "state", "made", "expires", "last used")
    rows = [
        (one.id, one.name, one.role, one.state, one.created_at[:16], (one.expires_at or "never")[:16],
         (one.last_used_at or "never")[:16])
        for one in tokens
    ]  # fmt: skip
    output().print(table(header, rows, numbers=()))

"""`servoident audit`: who changed what."""

from __future__ import annotations

from itertools import islice
from pathlib import Path
from typing import Annotated

import typer

from app.cli.data_options import Data, Database
from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.records import records


def audit(
    by: Annotated[str | None, typer.Option(metavar="ID", help="Only changes by the token of this id.")] = None,
    on: Annotated[
        str | None, typer.Option("--object", metavar="OBJECT", help="Only changes of this object, such as fits/ID.")
    ] = None,
    most: Annotated[int, typer.Option(metavar="N", min=0, help="Number of lines; 0: all.")] = 50,
    data: Data = None,
    database: Database = "",
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the lines as JSON; - is stdout.")] = None,
) -> None:
    """List all changes, newest first.

    Each line has time, token, action, object and request.
    """
    from app.access import service
    from app.cli.tables import output, table
    from app.paging import every

    check_target(json)
    with records(data, database) as found:
        lines = list(islice(every(lambda cursor: service.audit(found, cursor, 1000, by=by, on=on)), most or None))
    if json is not None:
        write_json([one.model_dump() for one in lines], json)
    if json == STANDARD_OUTPUT:
        return
    if not lines:
        print("no change is noted")
        return
    rows = [(one.at[:19], one.name, one.token, one.action, one.object, one.request) for one in lines]
    output().print(table(("time (UTC)", "who", "token", "action", "object", "request"), rows, numbers=()))

"""`servoident backup` and `servoident restore`: all that the service knows, in one file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.data_options import Blobs, Data, Database, settings
from app.cli.output import check_target
from app.cli.remote import Token, receive
from ident.errors import Unusable

if TYPE_CHECKING:
    from app.backup.service import Held

File = Annotated[Path, typer.Argument(metavar="FILE", help="The backup.")]


def backup(
    file: File,
    data: Data = None,
    database: Database = "",
    blobs: Blobs = "",
    server: Annotated[
        str, typer.Option(metavar="URL", help="Ask a running service for it instead of reading its data here.")
    ] = "",
    token: Token = "",
) -> None:
    """Write all records and raw uploads of a service to one file. The service may run meanwhile.

    From its data, or, with --server and a token of role admin, from wherever it answers.
    """
    from app.backup import service

    check_target(file)
    if server:
        if data or database or blobs:
            raise Unusable("bad-option", "the data of a service that is asked are where it has them", "--server",
                           "leave --data, --database and --blobs out")  # fmt: skip
        print(f"{file}: {receive(server, token, '/backups', file) / 1e6:.3f} MB")
        return
    print(f"{file}: {said(service.backup(settings(data, database, blobs=blobs), file))}")


def restore(file: File, data: Data = None, database: Database = "", blobs: Blobs = "") -> None:
    """Make an empty database and folder what a backup holds: also the other kind of database, or another store.

    Every table and every upload is verified by its hash first. Jobs that had not ended are queued again.
    """
    from app.backup import service

    print(f"restored from {file}: {said(service.restore(settings(data, database, blobs=blobs), file))}")


def said(held: Held) -> str:
    """What a backup holds, in words."""
    some = ", ".join(f"{count} {name.replace('_', ' ')}" for name, count in held.rows.items() if count)
    return f"{some or 'no records'}; {held.blobs} raw uploads"

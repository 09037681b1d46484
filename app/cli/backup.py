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

File = Annotated[Path, typer.Argument(metavar="FILE", help="Backup file.")]


def backup(
    file: File,
    data: Data = None,
    database: Database = "",
    blobs: Blobs = "",
    server: Annotated[
        str, typer.Option(metavar="URL", help="Get the backup from a running service instead of the local data.")
    ] = "",
    token: Token = "",
) -> None:
    """Write all records and raw uploads to one file.

    The service may run. It reads the data here, or asks a service with --server and a token of role admin.
    """
    from app.backup import service

    check_target(file)
    if server:
        if data or database or blobs:
            raise Unusable(
                "bad-option",
                "a running service uses its own data folder",
                "--server",
                "leave --data, --database and --blobs out",
            )
        print(f"{file}: {receive(server, token, '/backups', file) / 1e6:.3f} MB")
        return
    print(f"{file}: {said(service.backup(settings(data, database, blobs=blobs), file))}")


def restore(file: File, data: Data = None, database: Database = "", blobs: Blobs = "") -> None:
    """Restore a backup into an empty database and folder.

    The kind of database and the storage may differ from those of the backup. Every table and upload is first verified
    by its hash. Unfinished jobs are queued again.
    """
    from app.backup import service

    print(f"restored from {file}: {said(service.restore(settings(data, database, blobs=blobs), file))}")


def said(held: Held) -> str:
    """What a backup holds, in words."""
    some = ", ".join(f"{count} {name.replace('_', ' ')}" for name, count in held.rows.items() if count)
    return f"{some or 'no records'}; {held.blobs} raw uploads"

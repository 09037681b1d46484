"""`servoident tidy`: remove what need not be kept."""

from __future__ import annotations

from typing import Annotated

import typer

from app.cli.data_options import Blobs, Data, Database, settings
from ident.words.message import message


def tidy(
    hours: Annotated[float, typer.Option("--older-than", min=0, metavar="HOURS", help="Keep younger files.")] = 24,
    yes: Annotated[bool, typer.Option("--yes", help="Delete the files. Default: only show them.")] = False,
    data: Data = None,
    database: Database = "",
    blobs: Blobs = "",
) -> None:
    """Show or delete raw uploads without a record.

    Such files remain when an upload is interrupted. --yes deletes them.
    """
    from app.retention import service

    chosen = settings(data, database, blobs=blobs)
    found = service.unused(chosen, 3600 * hours)
    for blob in found:
        print(f"{blob.sha256}  {blob.size / 1e6:.3f} MB")
    if yes:
        service.remove(chosen, found)
    print(message("tidy.removed" if yes else "tidy.found", count=len(found)))

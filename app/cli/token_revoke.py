"""`servoident token revoke`: shut somebody out."""

from __future__ import annotations

from typing import Annotated

import typer

from app.cli.data_options import Data, Database
from app.cli.records import records


def revoke(
    token: Annotated[str, typer.Argument(metavar="ID", help="Id of a token, as `token list` shows it.")],
    data: Data = None,
    database: Database = "",
) -> None:
    """Revoke a token. Its next request is refused, and its sessions and streams end."""
    from app.access import service

    with records(data, database) as found:
        revoked = service.revoke(found, token, by=service.COMMAND)
    print(f"token {revoked.id} of {revoked.name} is revoked")

"""`servoident webhook list`: whom the service tells."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.remote import DEFAULT, Server, Token, items


def list_(
    server: Server = DEFAULT,
    token: Token = "",
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the list as JSON; - is stdout.")] = None,
) -> None:
    """List webhooks with their pending notifications, including revoked ones."""
    from app.cli.tables import output, table

    check_target(json)
    found = list(items(server, token, "/webhooks", {}))
    if json is not None:
        write_json(found, json)
    if json == STANDARD_OUTPUT:
        return
    if not found:
        print("there are no webhooks: servoident webhook new URL")
        return
    rows = [
        (one["id"], one["url"], " ".join(one["events"]), "revoked" if one["revoked_at"] else "in use",
         str(one["waiting"]), one["problem"])
        for one in found
    ]  # fmt: skip
    output().print(table(("id", "address", "events", "state", "waiting", "problem"), rows, numbers=("waiting",)))

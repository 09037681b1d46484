"""`servoident webhook deliveries`: what became of what a webhook was sent."""

from __future__ import annotations

from itertools import islice
from pathlib import Path
from typing import Annotated

import typer

from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.remote import DEFAULT, Server, Token, items, segment


def deliveries(
    webhook: Annotated[str, typer.Argument(metavar="ID", help="Id of a webhook, as `webhook list` shows it.")],
    most: Annotated[
        int, typer.Option(metavar="N", min=0, help="Number of deliveries; 0: all of the last 7 days.")
    ] = 50,
    server: Server = DEFAULT,
    token: Token = "",
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write them as JSON; - is stdout.")] = None,
) -> None:
    """List the deliveries of a webhook, newest first, with tries and errors."""
    from app.cli.tables import output, table

    check_target(json)
    found = list(islice(items(server, token, f"/webhooks/{segment(webhook)}/deliveries", {}), most or None))
    if json is not None:
        write_json(found, json)
    if json == STANDARD_OUTPUT:
        return
    if not found:
        print("it was sent nothing yet")
        return
    rows = [
        (one["created_at"][:19], one["event"], one["state"], str(one["tries"]), (one["next_at"] or "")[:19],
         one["problem"])
        for one in found
    ]  # fmt: skip
    output().print(table(("time (UTC)", "event", "state", "tries", "next", "problem"), rows, numbers=("tries",)))

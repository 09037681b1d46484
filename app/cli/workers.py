"""`servoident workers`: who works on the queue."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.remote import DEFAULT, Server, Token, request


def workers(
    server: Server = DEFAULT,
    token: Token = "",
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the answer as JSON; - is stdout.")] = None,
) -> None:
    """List workers, their jobs, and the queue of a service."""
    check_target(json)
    found = request(server, token, "GET", "/workers").json()
    if json is not None:
        write_json(found, json)
    if json == STANDARD_OUTPUT:
        return
    for one in found["workers"]:
        under_way = f"  {one['kind']} {one['job']} of {one['serial']}, turn {one['lease']}" if one["job"] else ""
        print(f"{one['name']}  {one['state']}  {one['host']} ({one['process']}){under_way}")
    print(f"{found['queue']['running']} jobs run, {found['queue']['queued']} wait")

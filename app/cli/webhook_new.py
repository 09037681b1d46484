"""`servoident webhook new`: tell an address of events."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from app.cli.remote import DEFAULT, Server, Token, request


def new(
    url: Annotated[str, typer.Argument(metavar="URL", help="URL to notify.")],
    event: Annotated[
        list[str] | None,
        typer.Option(
            metavar="EVENT", help="job.ended, set.approved, set.withdrawn or limit.broken; may be repeated; else all."
        ),
    ] = None,
    server: Server = DEFAULT,
    token: Token = "",
) -> None:
    """Create a webhook and print once the secret of its signatures."""
    body = {"url": url} | ({"events": event} if event else {})
    made = request(server, token, "POST", "/webhooks", json=body).json()
    print(f"webhook {made['id']} to {made['url']}: {', '.join(made['events'])}; its secret is not shown again:",
          file=sys.stderr)  # fmt: skip
    print(made["secret"])

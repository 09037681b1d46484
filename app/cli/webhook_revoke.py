"""`servoident webhook revoke`: tell an address nothing more."""

from __future__ import annotations

from typing import Annotated

import typer

from app.cli.remote import DEFAULT, Server, Token, request, segment


def revoke(
    webhook: Annotated[str, typer.Argument(metavar="ID", help="Id of a webhook, as `webhook list` shows it.")],
    server: Server = DEFAULT,
    token: Token = "",
) -> None:
    """Revoke a webhook. Pending notifications are dropped."""
    revoked = request(server, token, "DELETE", f"/webhooks/{segment(webhook)}").json()
    print(f"webhook {revoked['id']} to {revoked['url']} is revoked")

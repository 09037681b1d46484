"""`servoident approve`: make a fit its actuator's current parameter set."""

from __future__ import annotations

from typing import Annotated

import typer

from app.cli.remote import DEFAULT, Server, Token, request


def approve(
    fit: Annotated[str, typer.Argument(metavar="FIT", help="Id of a finished fit.")],
    server: Server = DEFAULT,
    token: Token = "",
) -> None:
    """Make a fit the current parameter set of its serial number. Older sets stay."""
    from urllib.parse import quote

    stored = request(server, token, "POST", f"/fits/{quote(fit, safe='', errors='surrogateescape')}/approve").json()
    print(f"fit {stored['id']} is the current parameter set of {stored['serial']}")

"""`servoident withdraw`: take a fit out of force."""

from __future__ import annotations

from typing import Annotated

import typer

from app.cli.approve import Why, decided
from app.cli.remote import DEFAULT, Server, Token


def withdraw(
    fit: Annotated[str, typer.Argument(metavar="FIT", help="Id of the fit in force.")],
    why: Why = "",
    server: Server = DEFAULT,
    token: Token = "",
) -> None:
    """Take a fit out of force: its serial number has no current set until one is approved. It stays stored."""
    stored = decided(server, token, fit, "withdraw", why)
    print(f"nothing is in force for {stored['serial']} any more")

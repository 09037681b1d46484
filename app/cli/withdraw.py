"""`servoident withdraw`: take a fit out of force."""

from __future__ import annotations

from typing import Annotated

import typer

from app.cli.approve import Why, decided
from app.cli.remote import DEFAULT, Server, Token


def withdraw(
    fit: Annotated[str, typer.Argument(metavar="FIT", help="Id of the approved fit.")],
    why: Why = "",
    server: Server = DEFAULT,
    token: Token = "",
) -> None:
    """Withdraw the approval of a fit.

    Its serial number has no current set until one is approved. The fit stays stored.
    """
    stored = decided(server, token, fit, "withdraw", why)
    print(f"no approved set for {stored['serial']} any more")

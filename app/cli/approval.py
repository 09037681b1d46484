"""`servoident approve` and `withdraw`: which fit is its actuator's current parameter set."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from app.cli.remote import DEFAULT, Server, Token, request, segment

Why = Annotated[str, typer.Option(help="Reason, stored with user and time.")]


def approve(
    fit: Annotated[str, typer.Argument(metavar="FIT", help="Id of a finished fit.")],
    why: Why = "",
    server: Server = DEFAULT,
    token: Token = "",
) -> None:
    """Approve a fit as current set of its serial number.

    Earlier sets stay stored.
    """
    stored = decided(server, token, fit, "approve", why)
    print(f"fit {stored['id']} is the current parameter set of {stored['serial']}")


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


def decided(server: str, token: str, fit: str, what: str, why: str) -> dict[str, Any]:
    """The fit after what was decided about it."""
    path = f"/fits/{segment(fit)}/{what}"
    stored: dict[str, Any] = request(server, token, "POST", path, json={"why": why}).json()
    return stored

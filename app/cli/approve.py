"""`servoident approve`: make a fit its actuator's current parameter set."""

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


def decided(server: str, token: str, fit: str, what: str, why: str) -> dict[str, Any]:
    """The fit after what was decided about it."""
    path = f"/fits/{segment(fit)}/{what}"
    stored: dict[str, Any] = request(server, token, "POST", path, json={"why": why}).json()
    return stored

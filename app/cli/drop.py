"""`servoident effects drop`: an own effect out of the list."""

from __future__ import annotations

from typing import Annotated

import typer

from app.cli.effects import Where
from app.cli.remote import Token, request, segment


def drop(
    name: Annotated[str, typer.Argument(metavar="NAME", help="Name of a saved effect.")],
    server: Where = "",
    token: Token = "",
) -> None:
    """Delete an own effect. Fits keep the effects that they were made with."""
    if server:
        request(server, token, "DELETE", f"/own-effects/{segment(name)}")
    else:
        from app.cli.kept_here import drop as drop_here

        drop_here(name)
    print(f"{name} is deleted")

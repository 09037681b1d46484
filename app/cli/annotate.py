"""`servoident annotate`: name, tags and note of a stored fit."""

from __future__ import annotations

from typing import Annotated

import typer

from app.cli.remote import DEFAULT, Server, Token, request, segment


def annotate(
    fit: Annotated[str, typer.Argument(metavar="FIT", help="Id of a finished fit.")],
    name: Annotated[str | None, typer.Option(metavar="NAME", help="Name of the fit; '' removes it.")] = None,
    tag: Annotated[
        list[str] | None, typer.Option(metavar="TAG", help="Tag; may be repeated. Replaces all tags; '' removes them.")
    ] = None,
    note: Annotated[str | None, typer.Option(metavar="TEXT", help="Note; '' removes it.")] = None,
    server: Server = DEFAULT,
    token: Token = "",
) -> None:
    """Name, tag or note a stored fit.

    An option that is not given changes nothing. Without any option the command prints name, tags and note.
    """
    path = f"/fits/{segment(fit)}/annotation"
    given = {"name": name, "tags": tag, "note": note}
    stated = {key: value for key, value in given.items() if value is not None}
    found = request(server, token, "GET", path).json()
    if stated:
        written = {key: found[key] for key in given} | stated
        found = request(server, token, "PUT", path, json=written).json()
    print(f"fit {fit}: {found['name'] or 'no name'}; tags: {', '.join(found['tags']) or 'none'}")
    if found["note"]:
        print(found["note"])

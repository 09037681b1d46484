"""`servoident search`: what the service holds by a text."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.remote import DEFAULT, Server, Token, request


def search(
    text: Annotated[str, typer.Argument(metavar="TEXT", help="Part of a serial number, name, batch, tag or note.")],
    server: Server = DEFAULT,
    token: Token = "",
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the answer as JSON; - is stdout.")] = None,
) -> None:
    """Search actuators, data sets and fits.

    Actuators are found by serial number, name or batch, fits by name, tag, note or the begin of their id, data sets by
    the begin of their id. Upper and lower case are the same.
    """
    from app.cli.tables import output, table

    check_target(json)
    found = request(server, token, "GET", "/search", params={"q": text}).json()
    if json is not None:
        write_json(found, json)
    if json == STANDARD_OUTPUT:
        return
    rows = [("actuator", one["serial"], one["serial"], f"{one['name']} {one['batch']}") for one in found["actuators"]]
    rows += [("data set", one["matrix"], one["serial"], one["created_at"][:10]) for one in found["data_sets"]]
    rows += [
        ("fit", one["fit"], one["serial"], ", ".join([one["name"] or one["model"], *one["tags"]]))
        for one in found["fits"]
    ]
    if rows:
        output().print(table(("kind", "id", "serial", "name"), rows, numbers=()))
    else:
        print(f"nothing holds {text!r}")

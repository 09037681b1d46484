"""`servoident retention`: raw runs that need not be kept."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.remote import DEFAULT, Server, Token, request
from ident.errors import Unusable


def retention(
    show: Annotated[bool, typer.Option("--show", help="Show what the rule would delete (default).")] = False,
    confirm: Annotated[
        str, typer.Option(metavar="DIGEST", help="Delete exactly the list that was shown with this digest.")
    ] = "",
    server: Server = DEFAULT,
    token: Token = "",
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the answer as JSON; - is stdout.")] = None,
) -> None:
    """Show or delete raw data by the retention rule.

    The rule (`serve --keep-raw DAYS`) covers superseded and unapproved fits. --confirm deletes; results are kept. It
    needs a token of role admin.
    """
    from app.cli.tables import output, table

    if show and confirm:
        raise Unusable("bad-option", "--show and --confirm cannot be combined", "--confirm", "leave --show out")
    check_target(json)
    if confirm:
        found = request(server, token, "POST", "/retention", json={"digest": confirm}).json()
    else:
        found = request(server, token, "GET", "/retention").json()
    if json is not None:
        write_json(found, json)
    if json == STANDARD_OUTPUT:
        return
    if found["days"] is None:
        print("no retention rule: all raw data are kept; set one by servoident serve --keep-raw DAYS")
        return
    rows = [
        (one["matrix"], one["serial"], one["created_at"][:10], one["why"], f"{one['bytes'] / 1e6:.3f}")
        for one in found["items"]
    ]
    if rows:
        output().print(table(("matrix", "serial", "uploaded", "its sets", "MB"), rows, numbers=("MB",)))
    total = f"raw runs of {len(rows)} matrices, {found['bytes'] / 1e6:.3f} MB"
    told = f"{total}, are removed" if confirm else f"{total}; to remove them: --confirm {found['digest']}"
    print(told if rows else f"nothing is to go that is older than {found['days']} days")

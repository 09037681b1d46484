"""`servoident token`: who may use the service. Create, list and revoke the tokens."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from app.cli.data_options import Data, Database
from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.records import records
from ident.errors import Unusable
from ident.words.nearest import did_you_mean

ROLES = ("lab", "line", "ci", "admin")
program = typer.Typer(rich_markup_mode=None)


@program.callback(invoke_without_command=True)
def token(context: typer.Context) -> None:
    """Create, list and revoke access tokens.

    Without a command it prints a new random start token. A start token has the role admin: give it to the service as
    SERVOIDENT_TOKEN. The commands read the data folder or the database, and need no token.
    """
    if context.invoked_subcommand is not None:
        return
    import secrets

    print(secrets.token_urlsafe(32))


@program.command("new")
def new(
    role: Annotated[str, typer.Option(metavar="ROLE", help="Role: lab, line, ci or admin.")],
    name: Annotated[str, typer.Option(metavar="NAME", help="Owner, as the audit shows it.")],
    expires: Annotated[
        str | None, typer.Option(metavar="TIME", help="Validity: 12h, 90d, 2w. Default: until revoked.")
    ] = None,
    data: Data = None,
    database: Database = "",
) -> None:
    """Create a token and print it once.

    The service stores only its hash. Roles: lab uploads, fits, diagnoses and approves; line reads and asks for
    verdicts; ci reads and runs regressions; admin may do everything.
    """
    from pydantic import ValidationError

    from app.access import service
    from app.access.secret import Secret
    from schemas.access import TokenRequest

    if role not in ROLES:
        raise Unusable("no-such-role", f"there is no role {role!r}", "--role", did_you_mean(role, ROLES))
    try:
        wanted = TokenRequest.model_validate({"name": name, "role": role, "expires": expires})
    except ValidationError as error:
        first = error.errors()[0]
        where = f"--{first['loc'][0]}"
        raise Unusable("bad-option", str(first["msg"]), where, "give one short line of text") from None
    with records(data, database) as found:
        made = service.new(found, wanted, Secret.draw(), by=service.COMMAND)
    until = f"until {made.expires_at[:16]} UTC" if made.expires_at else "until it is revoked"
    print(f"token {made.id} of {made.name}, {made.role}, valid {until}; it is not shown again:", file=sys.stderr)
    print(made.token)


@program.command("list")
def list_(
    data: Data = None,
    database: Database = "",
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the list as JSON; - is stdout.")] = None,
) -> None:
    """List tokens with role, state and last use, including expired ones."""
    from app.access import service
    from app.cli.tables import output, table
    from app.paging import every

    check_target(json)
    with records(data, database) as found:
        tokens = list(every(lambda cursor: service.listed(found, cursor, 1000)))
    if json is not None:
        write_json([one.model_dump() for one in tokens], json)
    if json == STANDARD_OUTPUT:
        return
    if not tokens:
        print("there are no tokens: servoident token new --role ROLE --name NAME")
        return
    header = ("id", "name", "role", "state", "made", "expires", "last used")
    rows = [
        (
            one.id,
            one.name,
            one.role,
            one.state,
            one.created_at[:16],
            (one.expires_at or "never")[:16],
            (one.last_used_at or "never")[:16],
        )
        for one in tokens
    ]
    output().print(table(header, rows, numbers=()))


@program.command("revoke")
def revoke(
    token: Annotated[str, typer.Argument(metavar="ID", help="Id of a token, as `token list` shows it.")],
    data: Data = None,
    database: Database = "",
) -> None:
    """Revoke a token. Its next request is refused, and its sessions and streams end."""
    from app.access import service

    with records(data, database) as found:
        revoked = service.revoke(found, token, by=service.COMMAND)
    print(f"token {revoked.id} of {revoked.name} is revoked")

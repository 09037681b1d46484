"""`servoident token new`: let somebody in."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from app.cli.data_options import Data, Database
from app.cli.records import records
from ident.errors import Unusable
from ident.words.nearest import did_you_mean

ROLES = ("lab", "line", "ci", "admin")


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

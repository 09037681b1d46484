"""`servoident token`: draw a start token for the service, or see to the tokens of those who use it."""

from __future__ import annotations

import typer


def token(context: typer.Context) -> None:
    """Create, list and revoke access tokens.

    Without a command it prints a new random start token. A start token has the role admin: give it to the service as
    SERVOIDENT_TOKEN. The commands read the data folder or the database, and need no token.
    """
    if context.invoked_subcommand is not None:
        return
    import secrets

    print(secrets.token_urlsafe(32))

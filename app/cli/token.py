"""`servoident token`: draw a start token for the service, or see to the tokens of those who use it."""

from __future__ import annotations

import typer


def token(context: typer.Context) -> None:
    """Make, list and revoke the tokens of those who use the service; alone, print a new random start token.

    A start token is the admin's: give it to the service as SERVOIDENT_TOKEN. The commands need the data folder or the
    database at hand, and no token.
    """
    if context.invoked_subcommand is not None:
        return
    import secrets

    print(secrets.token_urlsafe(32))

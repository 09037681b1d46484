"""`servoident webhook`: whom a service tells what has happened."""

from __future__ import annotations

import typer


def webhook(context: typer.Context) -> None:
    """Tell other systems of jobs that end, sets that are approved or withdrawn, and limits that are broken.

    What they are sent is signed, and sent again for 24 h until it is received. Only hosts that the service was started
    with are called (`servoident serve --webhook-host`). The commands need its address and a token of role admin.
    """
    if context.invoked_subcommand is None:
        print(context.get_help())

"""`servoident webhook`: whom a service tells what has happened."""

from __future__ import annotations

import typer


def webhook(context: typer.Context) -> None:
    """Notify other systems of events by webhooks.

    Events are: a job ends, a set is approved or withdrawn, a limit is violated. A notification is signed, and retried
    for 24 h. Only the hosts of `servoident serve --webhook-host` are called. The commands need the address of the
    service and a token of role admin.
    """
    if context.invoked_subcommand is None:
        print(context.get_help())

"""`servoident webhook`: whom the service tells what has happened, and what became of it."""

from __future__ import annotations

import sys
from itertools import islice
from pathlib import Path
from typing import Annotated

import typer

from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.remote import DEFAULT, Server, Token, items, request, segment

program = typer.Typer(rich_markup_mode=None)


@program.callback(invoke_without_command=True)
def webhook(context: typer.Context) -> None:
    """Notify other systems of events by webhooks.

    Events are: a job ends, a set is approved or withdrawn, a limit is violated. A notification is signed, and retried
    for 24 h. Only the hosts of `servoident serve --webhook-host` are called. The commands need the address of the
    service and a token of role admin.
    """
    if context.invoked_subcommand is None:
        print(context.get_help())


@program.command("new")
def new(
    url: Annotated[str, typer.Argument(metavar="URL", help="URL to notify.")],
    event: Annotated[
        list[str] | None,
        typer.Option(
            metavar="EVENT", help="job.ended, set.approved, set.withdrawn or limit.broken; may be repeated; else all."
        ),
    ] = None,
    server: Server = DEFAULT,
    token: Token = "",
) -> None:
    """Create a webhook and print once the secret of its signatures."""
    body = {"url": url} | ({"events": event} if event else {})
    made = request(server, token, "POST", "/webhooks", json=body).json()
    print(
        f"webhook {made['id']} to {made['url']}: {', '.join(made['events'])}; its secret is not shown again:",
        file=sys.stderr,
    )
    print(made["secret"])


@program.command("list")
def list_(
    server: Server = DEFAULT,
    token: Token = "",
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the list as JSON; - is stdout.")] = None,
) -> None:
    """List webhooks with their pending notifications, including revoked ones."""
    from app.cli.tables import output, table

    check_target(json)
    found = list(items(server, token, "/webhooks", {}))
    if json is not None:
        write_json(found, json)
    if json == STANDARD_OUTPUT:
        return
    if not found:
        print("there are no webhooks: servoident webhook new URL")
        return
    rows = [
        (
            one["id"],
            one["url"],
            " ".join(one["events"]),
            "revoked" if one["revoked_at"] else "in use",
            str(one["waiting"]),
            one["problem"],
        )
        for one in found
    ]
    output().print(table(("id", "address", "events", "state", "waiting", "problem"), rows, numbers=("waiting",)))


@program.command("revoke")
def revoke(
    webhook: Annotated[str, typer.Argument(metavar="ID", help="Id of a webhook, as `webhook list` shows it.")],
    server: Server = DEFAULT,
    token: Token = "",
) -> None:
    """Revoke a webhook. Pending notifications are dropped."""
    revoked = request(server, token, "DELETE", f"/webhooks/{segment(webhook)}").json()
    print(f"webhook {revoked['id']} to {revoked['url']} is revoked")


@program.command("deliveries")
def deliveries(
    webhook: Annotated[str, typer.Argument(metavar="ID", help="Id of a webhook, as `webhook list` shows it.")],
    most: Annotated[
        int, typer.Option(metavar="N", min=0, help="Number of deliveries; 0: all of the last 7 days.")
    ] = 50,
    server: Server = DEFAULT,
    token: Token = "",
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write them as JSON; - is stdout.")] = None,
) -> None:
    """List the deliveries of a webhook, newest first, with tries and errors."""
    from app.cli.tables import output, table

    check_target(json)
    found = list(islice(items(server, token, f"/webhooks/{segment(webhook)}/deliveries", {}), most or None))
    if json is not None:
        write_json(found, json)
    if json == STANDARD_OUTPUT:
        return
    if not found:
        print("it was sent nothing yet")
        return
    rows = [
        (
            one["created_at"][:19],
            one["event"],
            one["state"],
            str(one["tries"]),
            (one["next_at"] or "")[:19],
            one["problem"],
        )
        for one in found
    ]
    output().print(table(("time (UTC)", "event", "state", "tries", "next", "problem"), rows, numbers=("tries",)))

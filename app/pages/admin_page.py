"""What the admin's pages of webhooks and of what is kept show, gathered from the services."""

from __future__ import annotations

from typing import Any

from app.context import Context
from app.retention import rule
from app.webhooks import service as webhooks
from app.webhooks.hosts import origins

Shown = dict[str, Any]
_ROWS = 50  # of a table before its next page
_EVENTS = (
    ("job.ended", "a job has ended"),
    ("set.approved", "a set was approved"),
    ("set.withdrawn", "a set was withdrawn"),
    ("limit.broken", "a limit was broken"),
)


def retention_page(context: Context) -> Shown:
    """What the rule would remove."""
    found = rule.shown(context)
    rows = [(one, megabytes(one.bytes)) for one in found.items]
    return {"found": found, "rows": rows, "total": megabytes(found.bytes)}


def megabytes(size: int) -> str:
    """A number of bytes for a reader."""
    return f"{size / 1e6:.3g} MB"


def webhooks_page(context: Context, webhook: str, cursor: str | None, before: str | None) -> Shown:
    """Webhooks and the last deliveries: all, or those to one; raises Failure 404."""
    return {
        "found": webhooks.listed(context, cursor, _ROWS),
        "sent": webhooks.deliveries(context, webhook or None, before, _ROWS),
        "webhook": webhook,
        "events": _EVENTS,
        "hosts": sorted(origins(context.settings.webhook_hosts)),
    }

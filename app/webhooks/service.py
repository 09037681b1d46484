"""Webhooks: make, list, revoke, and see what became of what they were sent."""

from __future__ import annotations

from app.access.audited_changes import about
from app.context import Context
from app.errors import missing
from app.paging import cursor, keys_of
from app.tables import DeliveryRow, WebhookRow, now
from app.webhooks import repository
from app.webhooks.hosts import allowed
from app.webhooks.key import key_of
from schemas.webhooks import DeliveryPage, DeliveryView, NewWebhook, WebhookPage, WebhookRequest, WebhookView


def new(context: Context, request: WebhookRequest, who: str, webhook: str) -> NewWebhook:
    """Make a webhook under this id, and say its secret, this once. Raises Unusable where its host is not named."""
    origin = allowed(request.url, context.settings.webhook_hosts)
    key, events = key_of(context.settings), sorted(set(request.events))
    about(f"webhooks/{webhook}")
    with context.sessions.begin() as session:
        row = WebhookRow(
            id=webhook, url=request.url, origin=origin, events=events, key=key.print, who=who, created_at=now()
        )
        repository.add(session, row)
    return NewWebhook(**_view(row, 0, "").model_dump(), secret=key.secret(webhook))


def made_as(context: Context, webhook: str) -> NewWebhook | None:
    """The webhook that was made under this id, whose secret was said before."""
    with context.sessions() as session:
        row = repository.find(session, webhook)
    return None if row is None else NewWebhook(**_view(row, 0, "").model_dump(), secret=None)


def listed(context: Context, after: str | None, limit: int) -> WebhookPage:
    """A page of webhooks, oldest first."""
    with context.sessions() as session:
        rows = repository.page(session, keys_of(after, 2), limit)
        waiting = repository.waiting(session, [row.id for row in rows])
    following = cursor(rows[-1].created_at, rows[-1].id) if len(rows) == limit else None
    return WebhookPage(items=[_view(row, *waiting.get(row.id, (0, ""))) for row in rows], next=following)


def revoke(context: Context, webhook: str) -> WebhookView:
    """Revoke a webhook: it is told nothing more, also not what waits. Raises Failure 404."""
    with context.sessions.begin() as session:
        if repository.find(session, webhook) is None:
            raise missing("webhook", webhook)
        repository.revoke(session, webhook, now())
    with context.sessions() as session:
        row = repository.find(session, webhook)
    assert row is not None
    return _view(row, 0, "")


def deliveries(context: Context, webhook: str | None, after: str | None, limit: int) -> DeliveryPage:
    """A page of deliveries, newest first: all, or those of a webhook; raises Failure 404."""
    with context.sessions() as session:
        if webhook is not None and repository.find(session, webhook) is None:
            raise missing("webhook", webhook)
        rows = repository.deliveries(session, webhook, keys_of(after, 2), limit)
    following = cursor(rows[-1][0].created_at, rows[-1][0].id) if len(rows) == limit else None
    return DeliveryPage(items=[_delivery(*each) for each in rows], next=following)


def _view(row: WebhookRow, waiting: int, problem: str) -> WebhookView:
    return WebhookView(
        id=row.id,
        url=row.url,
        events=row.events,
        who=row.who,
        created_at=row.created_at,
        revoked_at=row.revoked_at,
        waiting=waiting,
        problem=problem,
    )


def _delivery(row: DeliveryRow, url: str) -> DeliveryView:
    return DeliveryView.model_validate(
        {
            "id": row.id,
            "webhook": row.webhook,
            "url": url,
            "event": row.event,
            "state": row.state,
            "tries": row.tries,
            "status": row.status,
            "problem": row.problem,
            "created_at": row.created_at,
            "next_at": row.next_at if row.state == "waiting" else None,
            "ended_at": row.ended_at,
        }
    )

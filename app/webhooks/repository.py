"""Every query on webhooks and deliveries."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from sqlalchemy import Select, delete, exists, func, select, tuple_, update
from sqlalchemy.orm import Session

from app.tables import DeliveryRow, WebhookRow

_AT_A_TIME = 1000


def add(session: Session, row: WebhookRow) -> None:
    """A new webhook; the commit raises IntegrityError where its id is there already."""
    session.add(row)


def find(session: Session, webhook: str) -> WebhookRow | None:
    """A webhook by id, also one that was revoked."""
    return session.get(WebhookRow, webhook)


def page(session: Session, after: tuple[str, ...] | None, limit: int) -> Sequence[WebhookRow]:
    """Webhooks, oldest first."""
    query = select(WebhookRow).order_by(WebhookRow.created_at, WebhookRow.id).limit(limit)
    if after is not None:
        query = query.where(tuple_(WebhookRow.created_at, WebhookRow.id) > after)
    return session.scalars(query).all()


def listening(session: Session, event: str) -> Sequence[str]:
    """The webhooks that are told of an event."""
    found = session.execute(select(WebhookRow.id, WebhookRow.events).where(WebhookRow.revoked_at.is_(None)))
    return [webhook for webhook, events in found if event in events]


def announce(session: Session, row: DeliveryRow) -> None:
    """A delivery."""
    session.add(row)


def revoke(session: Session, webhook: str, moment: str) -> None:
    """Revoke a webhook and drop what waits for it; the time of the first revocation stays."""
    open_ = update(WebhookRow).where(WebhookRow.id == webhook, WebhookRow.revoked_at.is_(None))
    session.execute(open_.values(revoked_at=moment))
    waiting = update(DeliveryRow).where(DeliveryRow.webhook == webhook, DeliveryRow.state == "waiting")
    session.execute(waiting.values(state="dropped", ended_at=moment))


def waiting(session: Session, webhooks: Sequence[str]) -> dict[str, tuple[int, str]]:
    """Of each of these: the number of its deliveries that wait, and what was wrong with one of them."""
    counted = select(DeliveryRow.webhook, func.count(), func.max(DeliveryRow.problem))
    counted = counted.where(DeliveryRow.webhook.in_(webhooks), DeliveryRow.state == "waiting")
    found = session.execute(counted.group_by(DeliveryRow.webhook))
    return {webhook: (count, problem) for webhook, count, problem in found}


def deliveries(
    session: Session, webhook: str | None, after: tuple[str, ...] | None, limit: int
) -> Sequence[tuple[DeliveryRow, str]]:
    """Deliveries, newest first, each with the address that it goes to: all, or those of a webhook."""
    query = select(DeliveryRow, WebhookRow.url).join(WebhookRow, WebhookRow.id == DeliveryRow.webhook)
    query = query.order_by(DeliveryRow.created_at.desc(), DeliveryRow.id.desc()).limit(limit)
    if webhook is not None:
        query = query.where(DeliveryRow.webhook == webhook)
    if after is not None:
        query = query.where(tuple_(DeliveryRow.created_at, DeliveryRow.id) < after)
    return [(row, url) for row, url in session.execute(query)]


def is_due(session: Session, origins: Collection[str], key: str, moment: str) -> bool:
    """Whether anything can be sent now."""
    return session.scalar(_due(origins, key, moment)) is not None


def claim(
    session: Session, origins: Collection[str], key: str, moment: str, until: str
) -> tuple[WebhookRow, int] | None:
    """A webhook that something is to be sent to, which is one's own until then, and the number of this turn."""
    free = _due(origins, key, moment).with_for_update(skip_locked=True, of=WebhookRow)
    one = update(WebhookRow).where(WebhookRow.id == free.scalar_subquery())
    taken = session.execute(one.values(leased_until=until, lease=WebhookRow.lease + 1).returning(WebhookRow)).first()
    return None if taken is None else (taken[0], taken[0].lease)


def _due(origins: Collection[str], key: str, moment: str) -> Select[str]:
    waits = exists().where(
        DeliveryRow.webhook == WebhookRow.id, DeliveryRow.state == "waiting", DeliveryRow.next_at <= moment
    )
    mine = select(WebhookRow.id).where(
        WebhookRow.revoked_at.is_(None), WebhookRow.origin.in_(origins), WebhookRow.key == key
    )
    return mine.where(WebhookRow.leased_until <= moment, waits).order_by(WebhookRow.leased_until).limit(1)


def hold(session: Session, webhook: str, lease: int, until: str) -> bool:
    """Keep a webhook for longer; False where it is another's by now, or was revoked."""
    own = update(WebhookRow).where(WebhookRow.id == webhook, WebhookRow.lease == lease)
    held = session.execute(own.where(WebhookRow.revoked_at.is_(None)).values(leased_until=until))
    return bool(held.rowcount)  # type: ignore[attr-defined]


def next_of(session: Session, webhook: str, moment: str) -> DeliveryRow | None:
    """The oldest delivery to a webhook that is due."""
    query = select(DeliveryRow).where(DeliveryRow.webhook == webhook, DeliveryRow.state == "waiting")
    query = query.where(DeliveryRow.next_at <= moment)
    return session.scalar(query.order_by(DeliveryRow.created_at, DeliveryRow.id).limit(1))


def note(session: Session, delivery: str, **values: object) -> None:
    """What came of a try; of a delivery that has ended meanwhile, nothing."""
    one = update(DeliveryRow).where(DeliveryRow.id == delivery, DeliveryRow.state == "waiting")
    session.execute(one.values(tries=DeliveryRow.tries + 1, **values))


def put_off(session: Session, webhook: str, until: str) -> None:
    """Let all that waits for a webhook wait until then."""
    early = update(DeliveryRow).where(DeliveryRow.webhook == webhook, DeliveryRow.state == "waiting")
    session.execute(early.where(DeliveryRow.next_at < until).values(next_at=until))


def give_up(session: Session, before: str, moment: str) -> None:
    """End the deliveries that were made before then and have not reached anyone."""
    late = update(DeliveryRow).where(DeliveryRow.state == "waiting", DeliveryRow.created_at < before)
    session.execute(late.values(state="given up", ended_at=moment))


def forget(session: Session, before: str) -> None:
    """Remove deliveries that ended before then; what another removes at this moment is left to it."""
    old = select(DeliveryRow.id).where(DeliveryRow.state != "waiting", DeliveryRow.created_at < before)
    some = old.limit(_AT_A_TIME).with_for_update(skip_locked=True)
    session.execute(delete(DeliveryRow).where(DeliveryRow.id.in_(some)))

"""Who is told of what, and what has still to reach them."""

from __future__ import annotations

from typing import Any

from sqlalchemy import ForeignKey, Index, Integer, String, Text, text
from sqlalchemy.orm import Mapped, mapped_column

from app.tables.base import Base, now

WAITING = text("state = 'waiting'")


class WebhookRow(Base):
    """An address that is told of events. Its secret is in no table: see `app/webhooks/key.py`, `key` says of which key.

    One process at a time sends to it: until `leased_until`, by its turn `lease`.
    """

    __tablename__ = "webhooks"
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    url: Mapped[str] = mapped_column(Text)
    origin: Mapped[str] = mapped_column(String(300))
    events: Mapped[list[Any]]
    key: Mapped[str] = mapped_column(String(64))
    who: Mapped[str] = mapped_column(String(200), default="")
    lease: Mapped[int] = mapped_column(Integer, default=0)
    leased_until: Mapped[str] = mapped_column(String(40), default="")
    created_at: Mapped[str] = mapped_column(String(40), default=now, index=True)
    revoked_at: Mapped[str | None] = mapped_column(String(40))


class DeliveryRow(Base):
    """An event on its way to a webhook: recorded with what it tells of, in one transaction."""

    __tablename__ = "deliveries"
    __table_args__ = (
        Index("ix_deliveries_waiting", "webhook", "next_at", sqlite_where=WAITING, postgresql_where=WAITING),
        Index("ix_deliveries_webhook", "webhook", "created_at"),
    )
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    webhook: Mapped[str] = mapped_column(ForeignKey("webhooks.id"))
    event: Mapped[str] = mapped_column(String(40))
    body: Mapped[str] = mapped_column(Text)
    state: Mapped[str] = mapped_column(String(20), default="waiting")
    tries: Mapped[int] = mapped_column(Integer, default=0)
    status: Mapped[int | None] = mapped_column(Integer)
    problem: Mapped[str] = mapped_column(Text, default="")
    created_at: Mapped[str] = mapped_column(String(40), default=now, index=True)
    next_at: Mapped[str] = mapped_column(String(40))
    ended_at: Mapped[str | None] = mapped_column(String(40))

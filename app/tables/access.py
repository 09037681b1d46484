"""Who may do what, who did what, and what was answered."""

from __future__ import annotations

from typing import Any

from sqlalchemy import BigInteger, ForeignKey, Integer, String, Text
from sqlalchemy.orm import Mapped, mapped_column

from app.tables.base import Base, now


class AnswerRow(Base):
    """What a POST with an Idempotency-Key was answered; without a status it is a claim that waits for its answer.

    `subject` is the id of what comes of it, decided with the claim; `created_at` the time of the claim.
    """

    __tablename__ = "idempotency"
    key: Mapped[str] = mapped_column(String(255), primary_key=True)
    fingerprint: Mapped[str] = mapped_column(String(64))
    subject: Mapped[str] = mapped_column(String(64), default="")
    status: Mapped[int | None] = mapped_column(Integer)
    body: Mapped[dict[str, Any]]
    location: Mapped[str] = mapped_column(Text, default="")
    created_at: Mapped[str] = mapped_column(String(40), default=now, index=True)


class TokenRow(Base):
    """A token: of its secret only a hash is kept. One that was revoked stays, for the audit names it."""

    __tablename__ = "tokens"
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    name: Mapped[str] = mapped_column(String(100))
    role: Mapped[str] = mapped_column(String(20))
    hash: Mapped[str] = mapped_column(String(64))
    created_at: Mapped[str] = mapped_column(String(40), default=now, index=True)
    expires_at: Mapped[str | None] = mapped_column(String(40))
    revoked_at: Mapped[str | None] = mapped_column(String(40))
    last_used_at: Mapped[str | None] = mapped_column(String(40))


class SessionRow(Base):
    """A browser that signed in by a token, or by the start token where it names none."""

    __tablename__ = "sessions"
    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    hash: Mapped[str] = mapped_column(String(64))
    token: Mapped[str | None] = mapped_column(ForeignKey("tokens.id"))
    created_at: Mapped[str] = mapped_column(String(40), default=now)
    expires_at: Mapped[str] = mapped_column(String(40), index=True)


class DisplayUnitsRow(Base):
    """The display units that an account has chosen: by the id of its token, or "start" for the start token."""

    __tablename__ = "display_units"
    account: Mapped[str] = mapped_column(String(64), primary_key=True)
    units: Mapped[list[Any]]


class AuditRow(Base):
    """A change: when, by which token, what, on what, in which request. The database refuses to change a row."""

    __tablename__ = "audit"
    id: Mapped[int] = mapped_column(BigInteger().with_variant(Integer, "sqlite"), primary_key=True)
    at: Mapped[str] = mapped_column(String(40), default=now)
    token: Mapped[str] = mapped_column(String(64), index=True)
    name: Mapped[str] = mapped_column(String(100))
    action: Mapped[str] = mapped_column(String(100))
    object: Mapped[str] = mapped_column(String(400), index=True)
    request: Mapped[str] = mapped_column(String(64))

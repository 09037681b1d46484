"""Every query on tokens, sessions, display units and the audit."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import delete, select, update
from sqlalchemy.orm import Session

from app.access.caller import Caller
from app.tables import AuditRow, DisplayUnitsRow, SessionRow, TokenRow, now


def add_token(session: Session, token: str, name: str, role: str, hashed: str, expires_at: str | None) -> TokenRow:
    """A new token; the commit raises IntegrityError where its id is there already."""
    row = TokenRow(id=token, name=name, role=role, hash=hashed, expires_at=expires_at, created_at=now())
    session.add(row)
    return row


def token(session: Session, token_id: str) -> TokenRow | None:
    """A token by id, also one that is valid no more."""
    return session.get(TokenRow, token_id)


def tokens(session: Session, after: tuple[str, ...] | None, limit: int) -> Sequence[TokenRow]:
    """Tokens by the time that they were made, then by id."""
    query = select(TokenRow).order_by(TokenRow.created_at, TokenRow.id).limit(limit)
    if after is not None:
        at, last = after
        later = (TokenRow.created_at > at) | ((TokenRow.created_at == at) & (TokenRow.id > last))
        query = query.where(later)
    return session.scalars(query).all()


def revoke(session: Session, token_id: str) -> None:
    """Revoke a token, and end the sessions that it began; the time of the first revocation stays."""
    open_ = update(TokenRow).where(TokenRow.id == token_id, TokenRow.revoked_at.is_(None))
    session.execute(open_.values(revoked_at=now()))
    session.execute(delete(SessionRow).where(SessionRow.token == token_id))


def used(session: Session, token_id: str) -> None:
    """Note that a token was used."""
    session.execute(update(TokenRow).where(TokenRow.id == token_id).values(last_used_at=now()))


def begin(session: Session, own: str, hashed: str, token_id: str | None, expires_at: str) -> None:
    """A new session; those that have expired are removed."""
    session.execute(delete(SessionRow).where(SessionRow.expires_at < now()))
    session.add(SessionRow(id=own, hash=hashed, token=token_id, expires_at=expires_at))


def browser(session: Session, session_id: str) -> SessionRow | None:
    """The session of a browser by id, also one that has expired."""
    return session.get(SessionRow, session_id)


def prolong(session: Session, session_id: str, expires_at: str) -> None:
    """Let a session that is used last longer."""
    session.execute(update(SessionRow).where(SessionRow.id == session_id).values(expires_at=expires_at))


def end(session: Session, session_id: str) -> None:
    """End a session."""
    session.execute(delete(SessionRow).where(SessionRow.id == session_id))


def display_units(session: Session, account: str) -> tuple[str, ...] | None:
    """The display units that an account has chosen; None where it has chosen none."""
    row = session.get(DisplayUnitsRow, account)
    return None if row is None else tuple(row.units)


def choose_units(session: Session, account: str, units: Sequence[str]) -> None:
    """Keep the display units of an account, in the place of those before."""
    session.merge(DisplayUnitsRow(account=account, units=list(units)))


def note(session: Session, who: Caller, action: str, on: str, request: str) -> None:
    """A line of the audit."""
    session.add(AuditRow(token=who.token, name=who.name, action=action, object=on[:400], request=request))


def noted(
    session: Session, after: int | None, limit: int, *, token_id: str | None = None, on: str | None = None
) -> Sequence[AuditRow]:
    """Lines of the audit, newest first: all, those of a token, those on an object."""
    query = select(AuditRow).order_by(AuditRow.id.desc()).limit(limit)
    for column, wanted in ((AuditRow.token, token_id), (AuditRow.object, on)):
        if wanted is not None:
            query = query.where(column == wanted)
    return session.scalars(query if after is None else query.where(AuditRow.id < after)).all()

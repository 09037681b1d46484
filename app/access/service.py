"""Tokens: make, list, revoke; sign in and out; choose display units; read the audit."""

from __future__ import annotations

from sqlalchemy.orm import Session, sessionmaker

from app.access import repository, sessions
from app.access.audited_changes import about
from app.access.caller import Caller, Role
from app.access.duration import duration
from app.access.identity import PresentedToken
from app.access.secret import Secret
from app.access.sessions import drop, end, keep
from app.access.token_attempts import TokenAttempts
from app.context import Context
from app.errors import Failure, missing
from app.paging import cursor, keys_of
from app.tables import AuditRow, TokenRow, before, now
from ident.words import display
from schemas.access import AuditPage, AuditView, DisplayUnits, NewToken, TokenPage, TokenRequest, TokenView

__all__ = [
    "COMMAND",
    "audit",
    "choose_units",
    "display_units",
    "drop",
    "end",
    "keep",
    "listed",
    "made_as",
    "new",
    "revoke",
    "sign_in",
]

Records = sessionmaker[Session]
COMMAND = Caller("command line", Role.ADMIN, "command")
"""Who has the data folder at hand and needs no token."""


def new(records: Records, request: TokenRequest, secret: Secret, by: Caller | None = None) -> NewToken:
    """Make a token of this secret, of which a hash is kept; noted where it is `by` a command. Raises Unusable."""
    expires_at = None if request.expires is None else before(-duration(request.expires))
    about(f"tokens/{secret.id}")
    with records.begin() as session:
        row = repository.add_token(session, secret.id, request.name, request.role, secret.hashed(), expires_at)
        if by is not None:
            repository.note(session, by, "new_token", f"tokens/{secret.id}", "")
    return NewToken(**view(row).model_dump(), token=str(secret))


def made_as(records: Records, token: str) -> NewToken | None:
    """The token that was made under this id, whose secret was said before."""
    with records() as session:
        row = repository.token(session, token)
    return None if row is None else NewToken(**view(row).model_dump(), token=None)


def listed(records: Records, after: str | None, limit: int) -> TokenPage:
    """A page of tokens, oldest first."""
    with records() as session:
        rows = repository.tokens(session, keys_of(after, 2), limit)
    following = cursor(rows[-1].created_at, rows[-1].id) if len(rows) == limit else None
    return TokenPage(items=[view(row) for row in rows], next=following)


def revoke(records: Records, token: str, by: Caller | None = None) -> TokenView:
    """Revoke a token, which its next request is refused by; noted where it is `by` a command. Raises Failure 404."""
    with records.begin() as session:
        if repository.token(session, token) is None:
            raise missing("token", token)
        repository.revoke(session, token)
        if by is not None:
            repository.note(session, by, "revoke_token", f"tokens/{token}", "")
    with records() as session:
        row = repository.token(session, token)
    assert row is not None
    return view(row)


def view(row: TokenRow) -> TokenView:
    """A token as it is sent."""
    expired = row.expires_at is not None and row.expires_at < now()
    return TokenView.model_validate(
        {
            "id": row.id,
            "name": row.name,
            "role": row.role,
            "created_at": row.created_at,
            "state": "revoked" if row.revoked_at else "expired" if expired else "valid",
            "expires_at": row.expires_at,
            "revoked_at": row.revoked_at,
            "last_used_at": row.last_used_at,
        }
    )


def sign_in(context: Context, tries: TokenAttempts, token: str, address: str) -> Secret:
    """Begin a session by a token; what its cookie is to hold. Raises Failure 401, 429."""
    return sessions.begin(context, tries.identify(context, PresentedToken(token.strip()), address))


def display_units(records: Records, who: Caller) -> DisplayUnits:
    """The display units that an account has chosen."""
    with records() as session:
        return DisplayUnits(units=list(repository.display_units(session, who.token) or ()))


def choose_units(records: Records, who: Caller, request: DisplayUnits) -> DisplayUnits:
    """Keep the display units of an account, each once. Raises Unusable."""
    with display.displaying(request.units):
        units = display.display_units()
    with records.begin() as session:
        repository.choose_units(session, who.token, units)
    return DisplayUnits(units=list(units))


def audit(records: Records, after: str | None, limit: int, *, by: str | None, on: str | None) -> AuditPage:
    """A page of the audit, newest first: all, what a token did, what was done to an object. Raises Failure 422."""
    keys = keys_of(after, 1)
    if keys and not (keys[0].isdecimal() and len(keys[0]) < 19):
        raise Failure(422, "bad-cursor", "the cursor is not one that a page gave", "cursor", "start without a cursor")
    with records() as session:
        rows = repository.noted(session, int(keys[0]) if keys else None, limit, token_id=by, on=on)
    following = cursor(str(rows[-1].id)) if len(rows) == limit else None
    return AuditPage(items=[_line(row) for row in rows], next=following)


def _line(row: AuditRow) -> AuditView:
    return AuditView(
        id=row.id, at=row.at, token=row.token, name=row.name, action=row.action, object=row.object, request=row.request
    )

"""Whose token a request carries, or whose session its cookie names: asked anew at every request."""

from __future__ import annotations

import hashlib
from contextlib import suppress
from dataclasses import dataclass, field, replace
from datetime import timedelta
from http.cookies import CookieError, SimpleCookie

from sqlalchemy.exc import OperationalError
from sqlalchemy.orm import Session
from starlette.datastructures import Headers

from app.access import repository
from app.access.caller import START, Caller, Role
from app.access.secret import Secret, same
from app.context import Context
from app.tables import SessionRow, TokenRow, before, now

COOKIE = "servoident"
LASTS = timedelta(days=7)
"""A session ends after so long without use."""
_RENEWED = timedelta(days=1)  # of that, after which a session that is used is prolonged
_SELDOM = timedelta(minutes=1)  # between two notes of a token's last use


@dataclass(frozen=True)
class PresentedToken:
    """What a request shows: the text of a token, or of a session's cookie."""

    text: str = field(repr=False)
    cookie: bool = False

    @property
    def print(self) -> str:
        """What tells it from others without saying it."""
        return hashlib.sha256(self.text.encode()).hexdigest()


def presented_by(headers: Headers) -> PresentedToken | None:
    """What headers show: a bearer's token, or else the cookie."""
    scheme, _, token = headers.get("authorization", "").partition(" ")
    if scheme.lower() == "bearer" and token.strip():
        return PresentedToken(token.strip())
    cookies: SimpleCookie = SimpleCookie()
    try:
        cookies.load(headers.get("cookie", ""))
    except CookieError:  # a malformed cookie is no cookie
        return None
    return PresentedToken(cookies[COOKIE].value, cookie=True) if COOKIE in cookies else None


def identify(context: Context, shown: PresentedToken) -> Caller | None:
    """Whose it is; None where it is nobody's, or is valid no more."""
    if not shown.cookie and same(shown.text, context.settings.token):
        return START
    secret = Secret.read(shown.text)
    if secret is None:
        return None
    with context.sessions() as session:
        if shown.cookie:
            return _of_cookie(context, session, secret)
        row = repository.token(session, secret.id)
        return _bearer(context, row) if row is not None and secret.is_of(row.hash) else None


def _of_cookie(context: Context, session: Session, secret: Secret) -> Caller | None:
    """A session of the start token is kept with that as key: another start, with another token, knows it no more."""
    row = repository.browser(session, secret.id)
    if row is None or row.expires_at < now():
        return None
    if not secret.is_of(row.hash, context.settings.token if row.token is None else ""):
        return None
    who = START if row.token is None else _bearer(context, repository.token(session, row.token))
    if who is None:
        return None
    _prolong(context, row)
    return replace(who, session=row.id, units=repository.display_units(session, who.token))


def _bearer(context: Context, row: TokenRow | None) -> Caller | None:
    if row is None or row.revoked_at is not None or (row.expires_at is not None and row.expires_at < now()):
        return None
    if row.last_used_at is None or row.last_used_at < before(_SELDOM):
        with suppress(OperationalError), context.sessions.begin() as session:  # of a full disk one still reads
            repository.used(session, row.id)
    return Caller(row.name, Role(row.role), row.id)


def _prolong(context: Context, row: SessionRow) -> None:
    """Let a session that is used last on: noted once a day."""
    if row.expires_at < before(_RENEWED - LASTS):
        with suppress(OperationalError), context.sessions.begin() as session:
            repository.prolong(session, row.id, before(-LASTS))

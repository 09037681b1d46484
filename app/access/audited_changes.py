"""A change and its line in the audit are one transaction: neither is there without the other, also after a kill.

The first transaction that a changing request commits carries the line. Those that are apart from the change, the claim
of an Idempotency-Key and its answer (:data:`app.database.APART`), do not.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Any

from sqlalchemy.orm import Session, sessionmaker
from starlette.types import Scope

from app.access import repository
from app.access.caller import Caller
from app.access.roles import declared
from app.database import on_commit
from app.request_id import request_id


@dataclass
class Change:
    """A request that may change something; `on` is what, where its address does not say so."""

    scope: Scope
    on: str = ""
    noted: bool = False

    @property
    def waits(self) -> bool:
        """Whether it is to leave a line, and has not."""
        declaration, who = declared(self.scope.get("route")), self.scope.get("state", {}).get("who")
        return not self.noted and declaration is not None and declaration.stores and isinstance(who, Caller)

    def note(self, session: Session) -> None:
        """Add its line to a transaction."""
        on = self.on or _address(self.scope)
        repository.note(session, self.scope["state"]["who"], self.scope["route"].name, on, request_id())


_current: ContextVar[Change | None] = ContextVar("change", default=None)


@contextmanager
def changing(scope: Scope) -> Iterator[Change]:
    """The change that a request is, while it is answered, in any of its threads."""
    change = Change(scope)
    token = _current.set(change)
    try:
        yield change
    finally:
        _current.reset(token)


def about(on: str) -> None:
    """What the request that is being answered makes: `jobs/ID`. To be said before it is committed."""
    change = _current.get()
    if change is not None:
        change.on = on


def carry(makers: sessionmaker[Session]) -> None:
    """Have the sessions of a service carry the lines of the changes that they commit."""
    on_commit(makers, _add, _added)


def _add(session: Session) -> None:
    change = _current.get()
    if change is not None and change.waits and "apart" not in session.info:
        change.note(session)
        session.info["noted"] = change


def _added(session: Session) -> None:
    change: Any = session.info.pop("noted", None)
    if change is not None:
        change.noted = True


def _address(scope: Scope) -> str:
    """What a request was about: its address up to the last part that names something."""
    path: str = scope["route"].path_format
    named = path[: path.rfind("}") + 1] or path
    return named.lstrip("/").format(**scope["path_params"])

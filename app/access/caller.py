"""Who asks: the bearer of a token, as every call knows it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated

from fastapi import Depends
from starlette.requests import HTTPConnection


class Role(StrEnum):
    """What a token is for."""

    LAB = "lab"
    """Upload, fit, diagnose, approve, set limits."""
    LINE = "line"
    """Read, and ask for verdicts."""
    CI = "ci"
    """Read, and run regressions."""
    ADMIN = "admin"
    """Everything; tokens and the audit alone."""


@dataclass(frozen=True)
class Caller:
    """The bearer of a token: its name, role and id; the session, where a browser asks, and its display units."""

    name: str
    role: Role
    token: str
    session: str | None = None
    units: tuple[str, ...] | None = None  # None: none were chosen

    def has(self, *roles: Role) -> bool:
        """Whether one of these roles is its own; the admin has all."""
        return self.role is Role.ADMIN or self.role in roles


START = Caller("start token", Role.ADMIN, "start")
"""The operator, who started the service: that token is in no database."""


def who_of(connection: HTTPConnection) -> Caller:
    """Who sent a request that a route's roles have let in."""
    who: Caller = connection.state.who
    return who


Me = Annotated[Caller, Depends(who_of)]

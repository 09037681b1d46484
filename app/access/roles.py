"""Which roles may call a route: declared where the route stands, and refused to all where it is not.

@router.post("", dependencies=[LAB])
@router.get("/{serial}/verdict", dependencies=[may(Role.LINE, Role.LAB)])
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from fastapi import Depends
from starlette.requests import HTTPConnection

from app.access.caller import Caller, Role
from app.errors import Failure


@dataclass(frozen=True)
class May:
    """A declaration: these roles may call it, and the admin, and anyone where it is `free`.

    A call of theirs is a change, which the audit has, unless its method is GET or it `stores` nothing.
    """

    roles: frozenset[Role]
    stores: bool = True
    free: bool = False

    async def __call__(self, connection: HTTPConnection) -> None:
        """Let the request pass. Raises Failure 401, 403."""
        who: Caller | None = getattr(connection.state, "who", None)
        if self.free:
            return
        if who is None:
            raise unknown()
        if not who.has(*self.roles):
            allowed = " or ".join(sorted(self.roles)) or Role.ADMIN
            raise Failure(
                403,
                "wrong-role",
                f"a token for {who.role} may not do this",
                "Authorization",
                f"use a token for {allowed}",
            )


def may(*roles: Role, stores: bool = True) -> Any:
    """The declaration of a route, for its `dependencies`: these roles may call it, and the admin may anyway."""
    return Depends(May(frozenset(roles), stores))


READERS = may(Role.LAB, Role.LINE, Role.CI, stores=False)
"""Looks, or asks a question of which nothing is stored."""
LAB = may(Role.LAB)
CI = may(Role.CI)
ADMIN = may()
ANYONE = Depends(May(frozenset(), stores=False, free=True))


def declared(route: Any) -> May | None:
    """What a route declares."""
    found = [each.dependency for each in getattr(route, "dependencies", ()) if isinstance(each.dependency, May)]
    return found[-1] if found else None


async def refuse_undeclared(connection: HTTPConnection) -> None:
    """Of every route: one that declares no role is refused to all. Raises Failure 403."""
    if declared(connection.scope.get("route")) is None:
        raise Failure(
            403,
            "no-role",
            "no role is declared for this address",
            connection.url.path,
            "a defect of the program: report it",
        )


def unknown() -> Failure:
    """Of a request that carries no token that is valid."""
    return Failure(
        401,
        "token-needed",
        "this request carries no valid token",
        "Authorization",
        "sign in at the address that the service printed, or send Authorization: Bearer TOKEN",
    )

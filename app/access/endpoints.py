"""/tokens, /display-units and /audit: who may do what, sees which units, and who did what."""

from __future__ import annotations

import json
from typing import Annotated

from fastapi import APIRouter, Query, Response
from fastapi.responses import JSONResponse

from app.access import service
from app.access.caller import Me, Role
from app.access.roles import ADMIN, READERS, may
from app.access.secret import Secret
from app.context import Here
from app.errors import COMMON
from app.idempotency import Answer, Key, fingerprint, once
from schemas.access import AuditPage, DisplayUnits, NewToken, TokenPage, TokenRequest, TokenView

router = APIRouter(tags=["access"], responses=COMMON)
Limit = Annotated[int, Query(ge=1, le=1000)]


@router.get("/tokens", dependencies=[ADMIN])
def list_tokens(here: Here, cursor: str | None = None, limit: Limit = 100) -> TokenPage:
    """Tokens, oldest first, with their last use; those that are valid no more, too."""
    return service.listed(here.sessions, cursor, limit)


@router.post("/tokens", status_code=201, response_model=NewToken, dependencies=[ADMIN])
def new_token(here: Here, request: TokenRequest, key: Key = None) -> Response:
    """Make a token. It is said in this answer and never again, also not to the same Idempotency-Key."""
    said: list[str | None] = [None]

    def answer(made: NewToken) -> Answer:
        return 201, made.model_dump() | {"token": None}, f"/api/v1/tokens/{made.id}"

    def find(token: str) -> Answer | None:
        made = service.made_as(here.sessions, token)
        return None if made is None else answer(made)

    def act(token: str) -> Answer:
        made = service.made_as(here.sessions, token) or service.new(here.sessions, request, Secret.draw(token))
        said[0] = made.token
        return answer(made)

    kept = once(here.sessions, key, fingerprint("token", request.model_dump()), act, find)
    return kept if said[0] is None else _saying(said[0], kept)


def _saying(token: str, kept: Response) -> Response:
    """The answer as it is kept, with the token, which is not."""
    content = json.loads(bytes(kept.body)) | {"token": token}
    return JSONResponse(content, kept.status_code, {"Location": kept.headers["Location"]})


@router.delete("/tokens/{token}", dependencies=[ADMIN])
def revoke_token(here: Here, token: str) -> TokenView:
    """Revoke a token: its next request is refused, its sessions end, its open streams end within 5 s."""
    return service.revoke(here.sessions, token)


@router.get("/display-units", dependencies=[READERS])
def get_display_units(here: Here, me: Me) -> DisplayUnits:
    """The display units of the account, in which it sees pages, figures and reports."""
    return service.display_units(here.sessions, me)


@router.put("/display-units", dependencies=[may(Role.LAB, Role.LINE, Role.CI)])
def set_display_units(here: Here, me: Me, request: DisplayUnits) -> DisplayUnits:
    """Choose the display units of the account, for every browser in which it signs in."""
    return service.choose_units(here.sessions, me, request)


@router.get("/audit", dependencies=[ADMIN])
def list_changes(
    here: Here,
    by: str | None = None,
    object: str | None = None,  # noqa: A002  the audit's name for it
    cursor: str | None = None,
    limit: Limit = 100,
) -> AuditPage:
    """Every change, newest first: all, those `by` a token's id, those of an object, such as `fits/ID`."""
    return service.audit(here.sessions, cursor, limit, by=by, on=object)

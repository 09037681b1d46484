"""/own-effects: a lab's own catalogue."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Response

from app.access.roles import LAB, READERS
from app.context import Here
from app.errors import COMMON
from app.idempotency import Answer, Key, fingerprint, once
from app.own_effects import service
from schemas.catalogue import OwnEffectPage, OwnEffectRequest, OwnEffectView

router = APIRouter(prefix="/own-effects", tags=["own effects"], responses=COMMON)


@router.get("", dependencies=[READERS])
def list_own_effects(
    here: Here, model: str | None = None, cursor: str | None = None, limit: Annotated[int, Query(ge=1, le=200)] = 50
) -> OwnEffectPage:
    """Own effects by name: all, or those that a model can take, of which a page may hold fewer than `limit`."""
    return service.listed(here, model, cursor, limit)


@router.get("/{name}", dependencies=[READERS])
def get_own_effect(here: Here, name: str) -> OwnEffectView:
    """An own effect: equations, parameters, definition, and where it comes from."""
    return service.get(here, name)


@router.post(
    "", dependencies=[LAB], status_code=201, response_model=OwnEffectView, responses={200: {"model": OwnEffectView}}
)
def keep_own_effect(here: Here, request: OwnEffectRequest, key: Key = None) -> Response:
    """Keep a definition, or a term that a diagnosis proposes; 200 where the same is kept under the name already."""

    def find(effect: str) -> Answer | None:
        found = service.kept_as(here, effect)
        return None if found is None else _answer(found, new=True)

    asked = fingerprint("own-effect", request.model_dump())
    return once(here.sessions, key, asked, lambda effect: _answer(*service.keep(here, request, effect)), find)


def _answer(kept: OwnEffectView, new: bool) -> Answer:
    return 201 if new else 200, kept.model_dump(by_alias=True), f"/api/v1/own-effects/{kept.name}"


@router.delete("/{name}", dependencies=[LAB], status_code=204, response_class=Response)
def drop_own_effect(here: Here, name: str) -> Response:
    """Remove an own effect from the list; fits and diagnoses carry the definitions that they were made with."""
    service.drop(here, name)
    return Response(status_code=204)

"""/webhooks: whom the service tells what has happened."""

from __future__ import annotations

import json
from typing import Annotated

from fastapi import APIRouter, Query, Response
from fastapi.responses import JSONResponse

from app.access.caller import Me
from app.access.roles import ADMIN
from app.context import Here
from app.errors import COMMON
from app.idempotency import Answer, Key, fingerprint, once
from app.webhooks import service
from schemas.webhooks import DeliveryPage, NewWebhook, WebhookPage, WebhookRequest, WebhookView

router = APIRouter(prefix="/webhooks", tags=["webhooks"], responses=COMMON)
Limit = Annotated[int, Query(ge=1, le=1000)]


@router.post("", status_code=201, response_model=NewWebhook, dependencies=[ADMIN])
def new_webhook(here: Here, me: Me, request: WebhookRequest, key: Key = None) -> Response:
    """Tell an address of events. Its secret is said in this answer and never again, also not to the same key."""
    said: list[str | None] = [None]

    def answer(made: NewWebhook) -> Answer:
        return 201, made.model_dump() | {"secret": None}, f"/api/v1/webhooks/{made.id}"

    def find(webhook: str) -> Answer | None:
        made = service.made_as(here, webhook)
        return None if made is None else answer(made)

    def act(webhook: str) -> Answer:
        made = service.made_as(here, webhook) or service.new(here, request, me.name, webhook)
        said[0] = made.secret
        return answer(made)

    kept = once(here.sessions, key, fingerprint("webhook", request.model_dump()), act, find)
    if said[0] is None:
        return kept
    content = json.loads(bytes(kept.body)) | {"secret": said[0]}
    return JSONResponse(content, kept.status_code, {"Location": kept.headers["Location"]})


@router.get("", dependencies=[ADMIN])
def list_webhooks(here: Here, cursor: str | None = None, limit: Limit = 100) -> WebhookPage:
    """Webhooks, oldest first, with what waits for them; those that were revoked, too."""
    return service.listed(here, cursor, limit)


@router.delete("/{webhook}", dependencies=[ADMIN])
def revoke_webhook(here: Here, webhook: str) -> WebhookView:
    """Revoke a webhook: it is told nothing more, also not what waits for it."""
    return service.revoke(here, webhook)


@router.get("/{webhook}/deliveries", dependencies=[ADMIN])
def list_deliveries(here: Here, webhook: str, cursor: str | None = None, limit: Limit = 100) -> DeliveryPage:
    """What a webhook was sent in the last 7 days, or is to be, newest first: tries, answers, what was wrong."""
    return service.deliveries(here, webhook, cursor, limit)

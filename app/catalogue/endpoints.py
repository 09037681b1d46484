"""/models and /effects: what can be fitted."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter, Response

from app.access.roles import READERS
from app.catalogue import service
from app.context import Here
from app.errors import COMMON
from app.idempotency import Key, fingerprint, once
from schemas.catalogue import EffectView, ModelView

router = APIRouter(tags=["catalogue"], responses=COMMON)


@router.get("/models", dependencies=[READERS])
def list_models() -> list[ModelView]:
    """Models with equations, parameters, units, bounds and sources."""
    return service.models()


@router.get("/effects", dependencies=[READERS])
def list_effects() -> list[EffectView]:
    """The catalogue of effects."""
    return service.effects()


@router.post("/custom-effects", dependencies=[READERS], response_model=EffectView)
def check_custom_effect(here: Here, definition: dict[str, Any] | str, key: Key = None) -> Response:
    """Check an effect of one's own, as JSON or as the text of its file; nothing is stored."""
    return once(
        here.sessions,
        key,
        fingerprint("custom-effect", definition),
        lambda _: (200, service.custom_effect(definition).model_dump(), ""),
    )

"""/models and /effects: what can be fitted."""

from __future__ import annotations

from fastapi import APIRouter

from app.catalogue import service
from app.errors import COMMON
from schemas.catalogue import EffectView, ModelView

router = APIRouter(tags=["catalogue"], responses=COMMON)


@router.get("/models")
def models() -> list[ModelView]:
    """Models with equations, parameters, units, bounds and sources."""
    return service.models()


@router.get("/effects")
def effects() -> list[EffectView]:
    """The catalogue of effects."""
    return service.effects()

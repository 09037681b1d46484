"""/fits/…: what the deletion of a fit deletes, and the deletion."""

from __future__ import annotations

from fastapi import APIRouter

from app.access.roles import LAB, READERS
from app.context import Here
from app.deletions import service
from app.errors import COMMON
from schemas.deletion import DeletionView

router = APIRouter(prefix="/fits", tags=["fits"], responses=COMMON)


@router.get("/{fit}/deletion", dependencies=[READERS])
def get_deletion(here: Here, fit: str) -> DeletionView:
    """What would be deleted together with a fit, and why it cannot be deleted where something forbids it."""
    return service.shown(here, fit)


@router.delete("/{fit}", dependencies=[LAB])
def delete_fit(here: Here, fit: str) -> DeletionView:
    """Delete a fit and all that was made of it; 409 where something still uses it. The data set stays."""
    return service.delete(here, fit)

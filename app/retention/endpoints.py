"""/retention: what the rule for raw runs would remove, and its removal."""

from __future__ import annotations

from fastapi import APIRouter

from app.access.roles import ADMIN
from app.context import Here
from app.errors import COMMON
from app.retention import rule
from schemas.retention import RetentionRequest, RetentionView

router = APIRouter(prefix="/retention", tags=["operation"], responses=COMMON)


@router.get("", dependencies=[ADMIN])
def show_retention(here: Here) -> RetentionView:
    """What the rule would remove now: raw runs of sets that were superseded or never approved, and are old enough."""
    return rule.shown(here)


@router.post("", dependencies=[ADMIN])
def carry_out_retention(here: Here, request: RetentionRequest) -> RetentionView:
    """Remove what was shown with this digest; 409 where it would be something else by now. Results stay."""
    return rule.carry_out(here, request.digest)

"""/fits: queue a fit, by a search, from an earlier result, or with effects added; and the way that led to one."""

from __future__ import annotations

from fastapi import APIRouter, Response

from app.access.caller import Me
from app.access.roles import LAB, READERS
from app.context import Here
from app.errors import COMMON
from app.idempotency import Key, fingerprint
from app.jobs.queueing import queued_once
from app.refits import lineage, starting
from schemas.fit import EffectsRequest, FitRequest, JobView, LadderView

router = APIRouter(prefix="/fits", tags=["fits"], responses=COMMON)


@router.post("", dependencies=[LAB], status_code=202, response_model=JobView)
def start_fit(here: Here, me: Me, request: FitRequest, key: Key = None) -> Response:
    """Queue a fit, by a search or from where an earlier result ended; Location is its job."""
    asked = fingerprint("fit", request.model_dump())
    return queued_once(here, key, asked, lambda job: starting.submit(here, request, job, me.name))


@router.post("/{fit}/effects", dependencies=[LAB], status_code=202, response_model=JobView)
def add_effects(here: Here, me: Me, fit: str, request: EffectsRequest, key: Key = None) -> Response:
    """Add effects to a fit and fit again with the same settings: a new fit whose parent is this one."""
    asked = fingerprint("effects", fit, request.model_dump())
    return queued_once(here, key, asked, lambda job: lineage.add(here, fit, request, job, me.name))


@router.get("/{fit}/ladder", dependencies=[READERS])
def get_ladder(here: Here, fit: str) -> LadderView:
    """The fits that this one comes from, the first one first; each can still be approved."""
    return lineage.ladder(here, fit)

"""/fits/ID/profile: the profile likelihood of a parameter, and the job that makes that of a model with effects."""

from __future__ import annotations

from fastapi import APIRouter, Response

from app.access.caller import Me
from app.access.roles import LAB, READERS
from app.context import Here
from app.errors import COMMON
from app.idempotency import Key, fingerprint
from app.jobs.queueing import queued_once
from app.profiles import service
from ident.comparison.profile import Profile
from schemas.fit import JobView, ProfileRequest

router = APIRouter(prefix="/fits", tags=["fits"], responses=COMMON)


@router.get("/{fit}/profile", dependencies=[READERS])
def get_profile(here: Here, fit: str, parameter: str) -> Profile:
    """The profile likelihood of a parameter, which holds at a bound too; with effects, once a job made it."""
    return service.found(here, fit, parameter)


@router.post("/{fit}/profiles", dependencies=[LAB], status_code=202, response_model=JobView)
def start_profile(here: Here, me: Me, fit: str, request: ProfileRequest, key: Key = None) -> Response:
    """Queue the profile likelihood of a parameter of any model; then it is had as that of a linear one is."""
    asked = fingerprint("profile", fit, request.model_dump())
    return queued_once(here, key, asked, lambda job: service.submit(here, fit, request.parameter, job, me.name))

"""/plans: the command files of a program of runs, inside the limits of a rig, which a job plans."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Query, Response
from fastapi.responses import FileResponse
from starlette.background import BackgroundTask

from app.access.roles import LAB, READERS
from app.context import Here
from app.errors import COMMON
from app.idempotency import Key, fingerprint
from app.jobs.queueing import queued_once
from app.plans import service
from schemas.fit import JobView
from schemas.plan import PlanPage, PlanRequest, PlanView

router = APIRouter(prefix="/plans", tags=["plans"], responses=COMMON)
_FILE: dict[int | str, dict[str, Any]] = {200: {"content": {"application/zip": {}}, "description": "The files"}}
Limit = Annotated[int, Query(ge=1, le=200)]
Format = Annotated[str, Query(max_length=10, description="Of the command files: csv, mat or tdms")]


@router.post("", dependencies=[LAB], status_code=202, response_model=JobView)
def start_plan(here: Here, request: PlanRequest, key: Key = None) -> Response:
    """Queue a plan of runs for a rig: each is scaled to stay inside the limits, or refused; Location is its job."""
    asked = fingerprint("plan", request.model_dump())
    return queued_once(here, key, asked, lambda job: service.submit(here, request, job))


@router.get("", dependencies=[READERS])
def list_plans(here: Here, fit: str | None = None, cursor: str | None = None, limit: Limit = 50) -> PlanPage:
    """Plans, newest first: all, or those of a fit."""
    return service.listed(here, fit, cursor, limit)


@router.get("/{plan}.zip", dependencies=[READERS], response_class=FileResponse, responses=_FILE)
def get_plan_files(here: Here, plan: str, format: Format = "csv") -> FileResponse:  # noqa: A002  its name in the query
    """The command files of a plan, plan.json and the matrix.yaml that the answers drop into."""
    file = service.archive(here, plan, format)
    task = BackgroundTask(service.drop, file)
    return FileResponse(file, media_type="application/zip", filename=f"plan-{plan[:12]}.zip", background=task)


@router.get("/{plan}", dependencies=[READERS])
def get_plan(here: Here, plan: str) -> PlanView:
    """A plan: every run with its amplitude and its share of the tightest limit, and the runs that are refused."""
    return service.get(here, plan)

"""/diagnoses: queue one, look at it, list those of a fit, propose the next run."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Response

from app.access.caller import Me
from app.access.roles import LAB, READERS
from app.context import Here
from app.diagnoses import proposal, service
from app.errors import COMMON
from app.idempotency import Key, fingerprint
from app.jobs.queueing import queued_once
from schemas.diagnosis import DiagnosisPage, DiagnosisRequest, DiagnosisView
from schemas.diagnosis_result import ProposalView
from schemas.fit import JobView

router = APIRouter(prefix="/diagnoses", tags=["diagnoses"], responses=COMMON)
Seed = Annotated[int, Query(ge=0, lt=2**31)]


@router.post("", dependencies=[LAB], status_code=202, response_model=JobView)
def start_diagnosis(here: Here, me: Me, request: DiagnosisRequest, key: Key = None) -> Response:
    """Queue the diagnosis of a fit, or of a matrix whose fit is made first; Location is its job."""
    asked = fingerprint("diagnosis", request.model_dump(exclude_unset=True))
    return queued_once(here, key, asked, lambda job: service.submit(here, request, job, me.name))


@router.get("", dependencies=[READERS], response_model_exclude_unset=True)
def list_diagnoses(
    here: Here, fit: str | None = None, cursor: str | None = None, limit: Annotated[int, Query(ge=1, le=200)] = 50
) -> DiagnosisPage:
    """Diagnoses, newest first: all, or those of a fit."""
    return service.listed(here, fit, cursor, limit)


@router.get("/{diagnosis}", dependencies=[READERS], response_model_exclude_unset=True)
def get_diagnosis(here: Here, diagnosis: str) -> DiagnosisView:
    """A diagnosis: what the fit lacks, ranked, with the ladder and the verdict."""
    return service.get(here, diagnosis)


@router.get("/{diagnosis}/proposal", dependencies=[READERS])
def get_proposal(here: Here, diagnosis: str, seed: Seed = 0) -> ProposalView:
    """The run that best separates the remaining hypotheses of the diagnosis, in words and numbers."""
    return proposal.proposal(here, diagnosis, seed)


@router.get(
    "/{diagnosis}/next-experiment",
    dependencies=[READERS],
    response_class=Response,
    responses={200: {"content": {"application/zip": {}}}},
)
def get_next_experiment(here: Here, diagnosis: str, seed: Seed = 0) -> Response:
    """The same run as a .zip: its command as CSV and MAT, and experiment.json."""
    name = f'attachment; filename="next-experiment-{diagnosis[:12]}.zip"'
    content = proposal.archive(here, diagnosis, seed)
    return Response(content, media_type="application/zip", headers={"Content-Disposition": name})

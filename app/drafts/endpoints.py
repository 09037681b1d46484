"""/drafts: raw files without a description, what they hold, and the matrix that answers make of them."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter, Request, Response
from fastapi.concurrency import run_in_threadpool

from app.access.caller import Role
from app.access.roles import LAB, may
from app.context import Here
from app.drafts import service
from app.errors import COMMON
from app.form import FORM, digests, files_of
from app.idempotency import Key, fingerprint, once
from schemas.draft import AnswersRequest, DraftView
from schemas.matrix import MatrixView

router = APIRouter(prefix="/drafts", tags=["matrices"], responses=COMMON)
_KNOWN: dict[int | str, dict[str, Any]] = {200: {"model": MatrixView, "description": "This matrix is known already"}}


@router.post("", dependencies=[LAB], status_code=201, response_model=DraftView, openapi_extra=FORM)
async def begin_draft(request: Request, here: Here, key: Key = None) -> Response:
    """Send raw files, a run each: their columns, what they state of them, and what has still to be said.

    They are kept for a day, or until a matrix is made of them.
    """
    service.check_room(here)
    async with files_of(request, "add raw files, a run each") as files:

        def act(_: str) -> tuple[int, dict[str, object], str]:
            made = service.begin(here, files)
            return 201, made.model_dump(), f"/api/v1/drafts/{made.id}"

        def answer() -> Response:
            return once(here.sessions, key, "" if key is None else fingerprint("draft", digests(files)), act)

        return await run_in_threadpool(answer)


@router.get("/{draft}", dependencies=[LAB])
def get_draft(here: Here, draft: str) -> DraftView:
    """A draft as it is without any answer."""
    return service.look(here, draft, AnswersRequest())


@router.post("/{draft}", dependencies=[may(Role.LAB, stores=False)])
def answer_draft(here: Here, draft: str, answers: AnswersRequest) -> DraftView:
    """What is known with these answers, what is missing; where nothing is, matrix.yaml and the doubts of the check."""
    return service.look(here, draft, answers)


@router.post("/{draft}/matrix", dependencies=[LAB], status_code=201, response_model=MatrixView, responses=_KNOWN)
def make_matrix(here: Here, draft: str, answers: AnswersRequest, key: Key = None) -> Response:
    """Create the data set, like an upload of matrix.yaml and the files. The draft is deleted."""

    def act(_: str) -> tuple[int, dict[str, object], str]:
        stored, new = service.make(here, draft, answers)
        return (201 if new else 200), stored.model_dump(), f"/api/v1/matrices/{stored.id}"

    return once(here.sessions, key, fingerprint("draft-matrix", draft, answers.model_dump()), act)

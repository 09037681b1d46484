"""/matrices: upload, look, mend."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Query, Request, Response
from fastapi.concurrency import run_in_threadpool

from app.access.roles import LAB, READERS
from app.context import Here
from app.errors import COMMON
from app.form import FORM, digests, files_of
from app.idempotency import Key, fingerprint, once
from app.matrices import service
from schemas.matrix import MatrixPage, MatrixView, Revision

router = APIRouter(prefix="/matrices", tags=["matrices"], responses=COMMON)


@router.post(
    "",
    dependencies=[LAB],
    status_code=201,
    response_model=MatrixView,
    openapi_extra=FORM,
    responses={200: {"model": MatrixView, "description": "These bytes are known already"}},
)
async def upload_matrix(request: Request, here: Here, key: Key = None) -> Response:
    """Upload one .zip, or matrix.yaml and its files. The same bytes again: 200 and the same id."""
    service.check_room(here)
    async with files_of(request, "add one .zip, or matrix.yaml and its files") as files:

        def act(_: str) -> tuple[int, dict[str, object], str]:
            stored, new = service.upload(here, files)
            return (201 if new else 200), stored.model_dump(), f"/api/v1/matrices/{stored.id}"

        def answer() -> Response:
            asked = "" if key is None else fingerprint("upload", digests(files))
            return once(here.sessions, key, asked, act)

        return await run_in_threadpool(answer)


@router.get("", dependencies=[READERS])
def list_matrices(
    here: Here,
    serial: str | None = None,
    cursor: str | None = None,
    limit: Annotated[int, Query(ge=1, le=200)] = 50,
) -> MatrixPage:
    """Matrices, newest first."""
    return service.listed(here, serial, cursor, limit)


@router.get("/{matrix}", dependencies=[READERS])
def get_matrix(here: Here, matrix: str) -> MatrixView:
    """A matrix, its runs and what the check found."""
    return service.get(here, matrix)


@router.get("/{matrix}/description", dependencies=[READERS])
def get_description(here: Here, matrix: str) -> dict[str, Any]:
    """What a revision changes: matrix.yaml as it stands, as JSON."""
    return service.description(here, matrix)


@router.post(
    "/{matrix}/revisions",
    dependencies=[LAB],
    status_code=201,
    response_model=MatrixView,
    responses={200: {"model": MatrixView, "description": "This revision is known already"}},
)
def revise_matrix(here: Here, matrix: str, revision: Revision, key: Key = None) -> Response:
    """Correct labels, units or signs: a new data set with the same raw files."""

    def act(_: str) -> tuple[int, dict[str, object], str]:
        stored, new = service.revise(here, matrix, revision)
        return (201 if new else 200), stored.model_dump(), f"/api/v1/matrices/{stored.id}"

    return once(here.sessions, key, fingerprint("revision", matrix, revision.model_dump()), act)

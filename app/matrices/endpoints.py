"""/matrices: upload, look, mend."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Query, Request, Response
from fastapi.concurrency import run_in_threadpool
from starlette.datastructures import UploadFile
from starlette.exceptions import HTTPException

from app.context import Here
from app.errors import COMMON, Failure
from app.idempotency import Key, fingerprint, once
from app.matrices import service
from schemas.matrix import MatrixPage, MatrixView, Revision

router = APIRouter(prefix="/matrices", tags=["matrices"], responses=COMMON)
_FORM = {
    "requestBody": {
        "required": True,
        "content": {
            "multipart/form-data": {
                "schema": {
                    "type": "object",
                    "properties": {"files": {"type": "array", "items": {"type": "string", "format": "binary"}}},
                    "required": ["files"],
                }
            }
        },
    }
}


@router.post("", status_code=201, response_model=MatrixView, openapi_extra=_FORM,
             responses={200: {"model": MatrixView, "description": "These bytes are known already"}})  # fmt: skip
async def upload(request: Request, here: Here, key: Key = None) -> Response:
    """Upload one .zip, or matrix.yaml and its files. The same bytes again: 200 and the same id."""
    if not request.headers.get("content-type", "").startswith("multipart/form-data"):
        raise Failure(
            415, "not-multipart", "the body is not multipart/form-data", "Content-Type", "send a form with files"
        )
    try:
        form = await request.form(max_files=20_000, max_fields=100)
    except Failure:
        raise
    except HTTPException as error:
        raise Failure(400, "bad-form", error.detail, "body", "send a multipart form with files") from None
    parts = [(part.filename or "", part.file) for _, part in form.multi_items() if isinstance(part, UploadFile)]
    files = dict(parts)
    if not files:
        raise Failure(422, "no-files", "the form holds no file", "body", "add one .zip, or matrix.yaml and its files")
    if len(files) < len(parts):
        raise Failure(422, "duplicate-file", "two files of the form have one name", "body", "give each its own name")

    def act(_: str) -> tuple[int, dict[str, object], str]:
        stored, new = service.upload(here, files)
        return (201 if new else 200), stored.model_dump(), f"/api/v1/matrices/{stored.id}"

    def answer() -> Response:
        asked = "" if key is None else fingerprint("upload", service.digests(files))
        return once(here.sessions, key, asked, act)

    try:
        return await run_in_threadpool(answer)
    finally:
        await form.close()


@router.get("")
def listed(
    here: Here, serial: str | None = None, cursor: str | None = None,
    limit: Annotated[int, Query(ge=1, le=200)] = 50,
) -> MatrixPage:  # fmt: skip
    """Matrices, newest first."""
    return service.listed(here, serial, cursor, limit)


@router.get("/{matrix}")
def one(here: Here, matrix: str) -> MatrixView:
    """A matrix, its runs and what the check found."""
    return service.get(here, matrix)


@router.get("/{matrix}/description")
def description(here: Here, matrix: str) -> dict[str, Any]:
    """What a revision changes: matrix.yaml as it stands, as JSON."""
    return service.description(here, matrix)


@router.post("/{matrix}/revisions", status_code=201, response_model=MatrixView,
             responses={200: {"model": MatrixView, "description": "This revision is known already"}})  # fmt: skip
def revise(here: Here, matrix: str, revision: Revision, key: Key = None) -> Response:
    """Mend labels, units or signs: a new matrix with the same raw bytes."""

    def act(_: str) -> tuple[int, dict[str, object], str]:
        stored, new = service.revise(here, matrix, revision)
        return (201 if new else 200), stored.model_dump(), f"/api/v1/matrices/{stored.id}"

    return once(here.sessions, key, fingerprint("revision", matrix, revision.model_dump()), act)

"""Every failure as a problem document (RFC 9457): what, where, remedy; never a traceback."""

from __future__ import annotations

import errno
import logging
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException

from ident.errors import Unusable
from schemas.problem import Problem

MEDIA = "application/problem+json"
_log = logging.getLogger("servoident")
_TITLES = {
    400: "Bad request", 401: "Token needed", 403: "Not allowed", 404: "Not found", 405: "Method not allowed",
    409: "Conflict", 411: "Length needed", 413: "Too large", 415: "Unsupported media type", 422: "Unusable input",
    500: "A defect of the program", 503: "Not ready", 507: "Disk full",
}  # fmt: skip


class Failure(Exception):
    """A refusal of the service, with its HTTP status."""

    def __init__(self, status: int, code: str, what: str, where: str, remedy: str) -> None:
        super().__init__(what)
        self.status, self.code, self.what, self.where, self.remedy = status, code, what, where, remedy


def missing(kind: str, name: str) -> Failure:
    """404 for something that is not there."""
    return Failure(404, f"no-such-{kind}", f"there is no {kind} {name!r}", kind, "list them to see which there are")


def problem(status: int, code: str, what: str, where: str = "", remedy: str = "", **headers: str) -> JSONResponse:
    """The response of a failure."""
    body = Problem(
        type=f"urn:servoident:problem:{code}", title=_TITLES.get(status, "Error"), status=status, code=code,
        detail=what, where=where, remedy=remedy,
    )  # fmt: skip
    return JSONResponse(body.model_dump(), status, media_type=MEDIA, headers=headers)


def _documented(*statuses: int) -> dict[int | str, dict[str, Any]]:
    schema = Problem.model_json_schema()
    return {status: {"description": _TITLES[status], "content": {MEDIA: {"schema": schema}}} for status in statuses}


COMMON = _documented(400, 401, 403, 404, 405, 409, 413, 415, 422, 503, 507)
"""Responses that every call may give, for the OpenAPI document."""


def install(app: FastAPI) -> None:
    """Answer every exception with a problem document."""

    async def failure(_: Request, error: Exception) -> JSONResponse:
        assert isinstance(error, Failure)
        return problem(error.status, error.code, error.what, error.where, error.remedy)

    async def unusable(_: Request, error: Exception) -> JSONResponse:
        assert isinstance(error, Unusable)
        return problem(422, error.code, error.what, error.where, error.remedy)

    async def invalid(_: Request, error: Exception) -> JSONResponse:
        assert isinstance(error, RequestValidationError)
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        return problem(422, "invalid-request", str(first["msg"]), where, "see the OpenAPI document for what is wanted")

    async def plain(_: Request, error: Exception) -> JSONResponse:
        assert isinstance(error, HTTPException)
        headers = dict(error.headers or {})
        return problem(error.status_code, f"http-{error.status_code}", str(error.detail), **headers)

    async def system(request: Request, error: Exception) -> JSONResponse:
        assert isinstance(error, OSError)
        if error.errno in (errno.ENOSPC, errno.EDQUOT):
            return problem(507, "disk-full", "no space is left on the disk", "upload", "free some space and try again")
        return await unexpected(request, error)

    async def unexpected(request: Request, error: Exception) -> JSONResponse:
        _log.error("%s %s failed", request.method, request.url.path, exc_info=error)
        return problem(500, "defect", "the request failed by a defect of the program", remedy="see the service's log")

    app.add_exception_handler(Failure, failure)
    app.add_exception_handler(Unusable, unusable)
    app.add_exception_handler(RequestValidationError, invalid)
    app.add_exception_handler(HTTPException, plain)
    app.add_exception_handler(OSError, system)
    app.add_exception_handler(Exception, unexpected)

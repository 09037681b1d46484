"""Every failure as a problem document (RFC 9457): what, where, remedy; never a traceback."""

from __future__ import annotations

import errno
import json
import logging
from collections.abc import Awaitable, Callable, Iterable, Mapping
from typing import Any

from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from sqlalchemy.exc import DataError, OperationalError
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect

from app.nearest_field import body_of, remedy
from app.storage import Unreachable
from ident.errors import Unusable
from ident.fit.added_effects import EFFECT_THERE
from ident.words.nearest import did_you_mean
from schemas.problem import Problem

MEDIA = "application/problem+json"
DISK_FULL = "53100"  # PostgreSQL's state
_CONFLICTS = frozenset({EFFECT_THERE})
"""Codes of input that is sound but does not go with what is there."""
_log = logging.getLogger("servoident")
_TITLES = {
    400: "Bad request",
    401: "Token needed",
    403: "Not allowed",
    404: "Not found",
    405: "Method not allowed",
    408: "Idle",
    409: "Conflict",
    410: "Gone",
    411: "Length needed",
    413: "Too large",
    415: "Unsupported media type",
    422: "Unusable input",
    426: "WebSocket needed",
    429: "Too often",
    500: "A defect of the program",
    503: "Not ready",
    507: "Disk full",
}


class Failure(HTTPException):
    """A refusal of the service, with its HTTP status; an HTTPException, which passes through whatever reads a body."""

    def __init__(self, status: int, code: str, what: str, where: str, remedy: str, **headers: str) -> None:
        super().__init__(status, what, headers)
        self.status, self.code, self.what, self.where, self.remedy = status, code, what, where, remedy


class Removed(Unusable):
    """Raw runs that were there and are gone; over HTTP 410."""


def missing(kind: str, name: str, known: Iterable[str] = ()) -> Failure:
    """404 for something that is not there, with the nearest of the names that are `known`."""
    remedy = did_you_mean(name, known, "correct the name, or choose one from the list")
    return Failure(404, f"no-such-{kind}", f"there is no {kind} {name!r}", kind, remedy)


def problem(status: int, code: str, what: str, where: str = "", remedy: str = "", **headers: str) -> Response:
    """The response of a failure, in ASCII: what it cites of a request may be no text that can be encoded."""
    body = Problem(
        type=f"urn:servoident:problem:{code}",
        title=_TITLES.get(status, "Error"),
        status=status,
        code=code,
        detail=what,
        where=where,
        remedy=remedy,
    )
    return Response(json.dumps(body.model_dump()), status, media_type=MEDIA, headers=headers)


def refusal(error: Failure, **headers: str) -> Response:
    """The response of a refusal."""
    headers = {**(error.headers or {}), **headers}
    return problem(error.status, error.code, error.what, error.where, error.remedy, **headers)


def _documented(*statuses: int) -> dict[int | str, dict[str, Any]]:
    schema = {"$ref": "#/components/schemas/Problem"}
    return {status: {"description": _TITLES[status], "content": {MEDIA: {"schema": schema}}} for status in statuses}


COMMON = _documented(400, 401, 403, 404, 405, 409, 410, 413, 415, 422, 429, 503, 507)
"""Responses that every call may give, for the OpenAPI document."""


async def _failure(_: Request, error: Exception) -> Response:
    assert isinstance(error, Failure)
    return refusal(error)


async def _unusable(_: Request, error: Exception) -> Response:
    assert isinstance(error, Unusable)
    status = 409 if error.code in _CONFLICTS else 422
    return problem(status, error.code, error.what, error.where, error.remedy)


async def _removed(_: Request, error: Exception) -> Response:
    assert isinstance(error, Removed)
    return problem(410, error.code, error.what, error.where, error.remedy)


async def _invalid(request: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError)
    first = error.errors()[0]
    where = ".".join(str(part) for part in first["loc"])
    return problem(422, "invalid-request", str(first["msg"]), where, remedy(first, body_of(request)))


async def _plain(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    headers, remedy = dict(error.headers or {}), "see the OpenAPI document for what there is"
    code = f"http-{error.status_code}"
    return problem(error.status_code, code, str(error.detail), request.url.path, remedy, **headers)


async def _gone(_: Request, __: Exception) -> Response:  # which nobody reads any more
    return problem(400, "incomplete", "the request ended before its body did", "body", "send the whole body")


async def _unstorable(_: Request, __: Exception) -> Response:
    return problem(422, "unusable-text", "it has characters that cannot be stored", "request", "write plain text")


async def unavailable(request: Request, error: Exception) -> Response:
    """Where the disk is full, or the database does not answer."""
    if is_full(error):
        return problem(507, "disk-full", "no space is left on the disk", "upload", "free some space and try again")
    if isinstance(error, OperationalError):
        _log.error("the database does not answer", exc_info=error)
        return problem(503, "no-database", "the database does not answer", "service", "try again in a moment")
    if isinstance(error, Unreachable):
        _log.error("the store of blobs does not answer", exc_info=error)
        return problem(503, "no-blobs", "the store of raw uploads does not answer", "service", "try again in a moment")
    return await _unexpected(request, error)


async def _unexpected(request: Request, error: Exception) -> Response:
    _log.error("%s %s failed", request.method, request.url.path, exc_info=error)
    return problem(500, "defect", "the request failed by a defect of the program", remedy="see the service's log")


_ANSWERS: Mapping[type[Exception], Callable[[Request, Exception], Awaitable[Response]]] = {
    Failure: _failure,
    Removed: _removed,
    Unusable: _unusable,
    RequestValidationError: _invalid,
    HTTPException: _plain,
    ClientDisconnect: _gone,
    DataError: _unstorable,
    UnicodeEncodeError: _unstorable,
    OSError: unavailable,
    OperationalError: unavailable,
    Exception: _unexpected,
}


def install(app: FastAPI) -> None:
    """Answer every exception with a problem document."""
    for error, answer in _ANSWERS.items():
        app.add_exception_handler(error, answer)


def is_full(error: Exception) -> bool:
    """True where a disk is full: the system says so, SQLite, or PostgreSQL."""
    if isinstance(error, OSError):
        return error.errno in (errno.ENOSPC, errno.EDQUOT)
    cause = getattr(error, "orig", None)
    return "disk is full" in str(cause) or getattr(cause, "sqlstate", "") == DISK_FULL

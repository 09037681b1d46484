"""Signing in and out, and the pages of tokens and of the audit."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Form, Request
from fastapi.responses import RedirectResponse, Response

from app.access import service
from app.access.caller import Me
from app.access.roles import ADMIN, ANYONE, READERS
from app.context import Here
from app.errors import Failure
from app.pages.problems import PageRoute
from app.pages.rendering import page

pages = APIRouter(include_in_schema=False, route_class=PageRoute)


@pages.get("/sign-in", dependencies=[ANYONE])
def signing_in(request: Request) -> Response:
    """The form that asks for a token."""
    return page(request, "sign_in.html", problem="", after="/")


@pages.post("/sign-in", dependencies=[ANYONE])
def signed_in(
    request: Request,
    here: Here,
    token: Annotated[str, Form(max_length=500)],
    after: Annotated[str, Form(max_length=2000)] = "/",
) -> Response:
    """Begin a session, and go on to the page that was asked for."""
    secure, address = request.url.scheme == "https", request.client.host if request.client else ""
    try:
        secret = service.sign_in(here, request.app.state.tries, token, address)
    except Failure as error:
        return page(request, "sign_in.html", error.status, problem=_tried(error), after=after)
    answer = RedirectResponse(after if _is_here(after) else "/", 303)
    service.keep(answer, secret, secure)
    return answer


def _tried(error: Failure) -> str:
    return "this token is not valid, or no longer" if error.status == 401 else f"{error.what}: {error.remedy}"


def _is_here(address: str) -> bool:
    """Whether an address is a page of this service; what follows two slashes of either kind would be another host."""
    return address.startswith("/") and address[1:2] not in ("/", "\\") and address.isprintable()


@pages.post("/sign-out", dependencies=[READERS])
def signed_out(request: Request, here: Here, me: Me) -> Response:
    """End the session."""
    service.end(here, me)
    answer = RedirectResponse("/sign-in", 303)
    service.drop(answer, request.url.scheme == "https")
    return answer


@pages.get("/tokens", dependencies=[ADMIN])
def tokens(request: Request, here: Here, cursor: str | None = None) -> Response:
    """Tokens, and the form that makes one."""
    return page(request, "tokens.html", found=service.listed(here.sessions, cursor, 100))


@pages.get("/audit", dependencies=[ADMIN])
def audit(
    request: Request,
    here: Here,
    by: str | None = None,
    object: str | None = None,  # noqa: A002
    cursor: str | None = None,
) -> Response:
    """Every change, newest first."""
    found = service.audit(here.sessions, cursor, 100, by=by or None, on=object or None)
    return page(request, "audit.html", found=found, by=by or "", on=object or "")

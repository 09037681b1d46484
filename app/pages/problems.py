"""What goes wrong behind a page is said on a page: what, where, and what to do."""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from typing import Any

from fastapi import Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.routing import APIRoute
from starlette.exceptions import HTTPException
from starlette.routing import Match
from starlette.types import Scope

from app.errors import Failure, Removed
from app.pages.rendering import page, problem
from ident.errors import Unusable

Handler = Callable[[Request], Coroutine[Any, Any, Response]]


class PageRoute(APIRoute):
    """A route whose refusals are pages."""

    def get_route_handler(self) -> Handler:
        """The handler, with refusals turned into pages."""
        handle = super().get_route_handler()

        async def handled(request: Request) -> Response:
            try:
                return await handle(request)
            except Failure as error:
                title = "Not found" if error.status == 404 else "That did not work"
                return problem(request, error.status, title, error.what, error.remedy)
            except Removed as error:
                return problem(request, 410, "Removed", error.what, error.remedy)
            except Unusable as error:
                return problem(request, 422, "That cannot be used", f"{error.where}: {error.what}", error.remedy)
            except RequestValidationError as error:
                first = error.errors()[0]
                where = str(first["loc"][-1])
                return problem(request, 422, "That cannot be used", f"{where}: {first['msg']}", "correct the address")
            except HTTPException as error:
                return _unknown(request, error.status_code)

        return handled


class Unknown(PageRoute):
    """Any other address, but for those of the API, whose answers are not pages."""

    def matches(self, scope: Scope) -> tuple[Match, Scope]:
        """No match under /api."""
        return (Match.NONE, {}) if str(scope.get("path", "")).startswith("/api/") else super().matches(scope)


def sign_in(request: Request, error: Failure) -> Response:
    """The page that asks for a token, in place of the one that was asked for; after it that one is shown."""
    tried = "" if error.code == "token-needed" else f"{error.what}: {error.remedy}"
    after = request.url.path + (f"?{request.url.query}" if request.url.query else "")
    shown = page(request, "sign_in.html", error.status, problem=tried, after=after)
    shown.headers.update(error.headers or {})
    return shown


def _unknown(request: Request, status: int) -> Response:
    return problem(
        request,
        status,
        "Not found",
        f"there is nothing at {request.url.path[:200]}",
        "start from the list of actuators",
    )

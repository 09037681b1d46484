"""The display units of whoever looks at a page: kept in a cookie of the browser, for its pages, figures and reports."""

from __future__ import annotations

from urllib.parse import unquote

from starlette.datastructures import Headers
from starlette.requests import cookie_parser
from starlette.types import ASGIApp, Receive, Scope, Send

from ident.words.display import displaying, known

COOKIE = "units"


class Display:
    """Answers each GET in the units that its cookie names, separated by commas; what is no unit counts as none.

    What other requests store has no display units.
    """

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Set the units, then pass on."""
        cookies = Headers(scope=scope).get("cookie", "") if scope.get("method") == "GET" else ""
        with displaying(known(unquote(cookie_parser(cookies).get(COOKIE, "")))):
            await self.app(scope, receive, send)

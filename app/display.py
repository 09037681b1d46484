"""The display units of whoever looks at a page, for pages, figures and reports: the account's, or those of a cookie.

A browser is shown what its account has chosen. Where that has chosen none, and for commands and scripts, the cookie of
the request counts.
"""

from __future__ import annotations

from urllib.parse import unquote

from starlette.datastructures import Headers
from starlette.requests import cookie_parser
from starlette.types import ASGIApp, Receive, Scope, Send

from app.access.caller import Caller
from ident.words.display import displaying, known

COOKIE = "units"


class Display:
    """Answers each GET in the display units of who asks; what is no unit counts as none.

    What other requests store has no display units.
    """

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Set the units, then pass on."""
        with displaying(known(_asked(scope)) if scope.get("method") == "GET" else ()):
            await self.app(scope, receive, send)


def _asked(scope: Scope) -> str:
    """The units' names with commas between."""
    who: Caller | None = scope.get("state", {}).get("who")
    if who is not None and who.units is not None:
        return ",".join(who.units)
    cookies = Headers(scope=scope).get("cookie", "")
    return unquote(cookie_parser(cookies).get(COOKIE, ""))

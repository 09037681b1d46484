"""The gate: a request comes in with a token that is valid, and an answer that lasts ends when the token does."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from urllib.parse import parse_qsl, urlencode

import anyio
from sqlalchemy.exc import OperationalError
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import Headers
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.access import sessions
from app.access.caller import START, Caller
from app.access.identity import PresentedToken, identify, presented_by
from app.access.rates import Rate
from app.access.roles import unknown
from app.access.token_attempts import TokenAttempts, too_often
from app.context import Context
from app.errors import Failure, refusal, unavailable

OPEN = ("/api/v1/health", "/api/v1/ready", "/sign-in")
"""Addresses that anyone may ask for, as their routes declare too."""
STATIC = "/static/"
"""The beginning of the addresses of what the sign-in is drawn with."""
LOOK = 2.0
"""s between two looks whether the token of an answer that lasts is still valid."""
SignIn = Callable[[Request, Failure], Response]
"""Makes the page that asks for a token, and says why."""


class Gate:
    """ASGI middleware: finds out who asks, and refuses whom it does not know, and who asks too often."""

    def __init__(self, app: ASGIApp, context: Context, tries: TokenAttempts, sign_in: SignIn) -> None:
        self.app, self.context, self.tries, self.sign_in = app, context, tries, sign_in
        self.uses = Rate(context.settings.rate, 10 * context.settings.rate)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Look at the token, then pass on."""
        if scope["type"] not in ("http", "websocket") or scope["path"] in OPEN or scope["path"].startswith(STATIC):
            await self.app(scope, receive, send)
            return
        shown = presented_by(Headers(scope=scope))
        try:
            answer = await self._signed_in(scope)
            if answer is None:
                scope.setdefault("state", {})["who"] = await self._let_in(scope, shown)
        except Failure as error:
            answer = self._refused(scope, error)
        except (OSError, OperationalError) as error:
            answer = await unavailable(_request(scope), error)
        if answer is not None:
            await answer(scope, receive, send)
            return
        await self._answered(scope, receive, send, shown)

    async def _signed_in(self, scope: Scope) -> Response | None:
        """The answer to the address that the service printed: a session, and the address without the token."""
        if scope["type"] != "http" or scope["method"] != "GET" or b"token=" not in scope["query_string"]:
            return None
        query = parse_qsl(scope["query_string"].decode("latin-1"), keep_blank_values=True)
        token = dict(query).get("token")
        if token is None:
            return None
        try:
            who = await run_in_threadpool(self.tries.identify, self.context, PresentedToken(token), address(scope))
        except Failure:
            return None
        if who is not START:
            return None
        rest = urlencode([(name, value) for name, value in query if name != "token"])
        answer = RedirectResponse(scope["path"] + (f"?{rest}" if rest else ""), 303)
        secret = await run_in_threadpool(sessions.begin, self.context, who)
        sessions.keep(answer, secret, scope["scheme"] == "https")
        return answer

    async def _let_in(self, scope: Scope, shown: PresentedToken | None) -> Caller:
        """Who asks. Raises Failure 401, 429."""
        if shown is None:
            raise unknown()
        who = await run_in_threadpool(self.tries.identify, self.context, shown, address(scope))
        if who.token != START.token:
            wait = self.uses.wait(who.token)
            if wait:
                raise too_often("requests came with this token", wait)
            self.uses.count(who.token)
        return who

    def _refused(self, scope: Scope, error: Failure) -> Response:
        """A refusal as a page where a reader asks, else as a problem document."""
        request = _request(scope)
        reads = "text/html" in request.headers.get("accept", "") and not scope["path"].startswith("/api/")
        return self.sign_in(request, error) if reads else refusal(error)

    async def _answered(self, scope: Scope, receive: Receive, send: Send, shown: PresentedToken | None) -> None:
        """Pass on; where the token ends meanwhile, the answer ends too."""
        begun = False

        async def noticed(message: Message) -> None:
            nonlocal begun
            begun = begun or message["type"] == "http.response.start"
            await send(message)

        with anyio.CancelScope() as answering:
            watch = asyncio.create_task(self._watched(shown, answering))
            try:
                await self.app(scope, receive, noticed)
            finally:
                watch.cancel()
        if answering.cancelled_caught:
            await _ended(scope, receive, send, begun)

    async def _watched(self, shown: PresentedToken | None, answering: anyio.CancelScope) -> None:
        who: Caller | None = START
        while shown is not None and who is not None:
            await asyncio.sleep(LOOK)
            with suppress(OSError, OperationalError):  # of a database that does not answer nothing is known
                who = await run_in_threadpool(identify, self.context, shown)
        answering.cancel()


def address(scope: Scope) -> str:
    """Where a request comes from: of one that a named proxy passed on, what that says."""
    return scope["client"][0] if scope.get("client") else ""


def _request(scope: Scope) -> Request:
    """The request, also where it is that of a socket."""
    return Request({"method": "GET", **scope, "type": "http"})


async def _ended(scope: Scope, receive: Receive, send: Send, begun: bool) -> None:
    with suppress(RuntimeError):  # it may have gone, or ended, meanwhile
        if scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1008, "reason": "token-needed"})
        elif begun:
            await send({"type": "http.response.body", "body": b"", "more_body": False})
        else:
            await refusal(unknown())(scope, receive, send)

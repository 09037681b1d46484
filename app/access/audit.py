"""The audit: a line for every change, in the transaction of the change; and for what changed no record, too."""

from __future__ import annotations

from sqlalchemy.exc import OperationalError
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import Headers
from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.access.audited_changes import Change, changing
from app.context import Context
from app.errors import unavailable

API = "/api/v1/"
_READING = ("GET", "HEAD", "OPTIONS")


class Audited:
    """ASGI middleware: a change that no transaction of its own carried is noted before it is answered.

    A request that is repeated under its key, files that wait for a description. What cannot be noted is no success.
    """

    def __init__(self, app: ASGIApp, context: Context) -> None:
        self.app, self.context = app, context

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on, and note what was changed."""
        if scope["type"] != "http" or scope["method"] in _READING:
            await self.app(scope, receive, send)
            return
        unnoted = False

        async def noted(message: Message) -> None:
            nonlocal unnoted
            if message["type"] == "http.response.start" and message["status"] < 400 and change.waits:
                try:
                    await run_in_threadpool(self._note, change, Headers(raw=message["headers"]))
                except (OSError, OperationalError) as error:
                    unnoted = True
                    await (await unavailable(Request(scope), error))(scope, receive, send)
            if not unnoted:
                await send(message)

        with changing(scope) as change:
            await self.app(scope, receive, noted)

    def _note(self, change: Change, headers: Headers) -> None:
        """In a transaction of its own, which holds nothing else."""
        change.on = headers.get("location", "").removeprefix(API) or change.on
        with self.context.sessions.begin():
            pass

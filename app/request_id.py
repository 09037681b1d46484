"""Each request has an id: the X-Request-ID that it came with, or a new one. Answer, audit and logs name it."""

from __future__ import annotations

import re
from contextvars import ContextVar
from uuid import uuid4

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

NAME = "X-Request-ID"
_SANE = re.compile(r"[A-Za-z0-9._-]{1,64}")
_current: ContextVar[str] = ContextVar("request_id", default="")


def request_id() -> str:
    """The id of the request that is being answered, in any of its threads; "" elsewhere."""
    return _current.get()


class RequestId:
    """ASGI middleware: gives the request its id, and says it in the answer."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Name the request, then pass it on."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        given = Headers(scope=scope).get(NAME, "")
        own = given if _SANE.fullmatch(given) else uuid4().hex
        token = _current.set(own)

        async def named(message: Message) -> None:
            if message["type"] in ("http.response.start", "websocket.http.response.start", "websocket.accept"):
                MutableHeaders(raw=message.setdefault("headers", [])).setdefault(NAME, own)
            await send(message)

        try:
            await self.app(scope, receive, named)
        finally:
            _current.reset(token)

"""Each request counted, timed and logged."""

from __future__ import annotations

import logging
import time

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.operation.metrics import Requests

API = "/api/v1"
_log = logging.getLogger("servoident.requests")


class Observed:
    """ASGI middleware: notes how each request was answered, by the route that it met."""

    def __init__(self, app: ASGIApp, requests: Requests) -> None:
        self.app, self.requests = app, requests

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on, and note."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        began, status = time.perf_counter(), 500

        async def noted(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
            await send(message)

        self.requests.open.inc()
        try:
            await self.app(scope, receive, noted)
        finally:
            self.requests.open.dec()
            self._note(scope, status, time.perf_counter() - began)

    def _note(self, scope: Scope, status: int, seconds: float) -> None:
        route = _pattern(scope)
        known = scope["method"] in ("GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS")
        method = scope["method"] if known else "other"
        self.requests.answered.labels(method, route, str(status)).inc()
        self.requests.seconds.labels(method, route).observe(seconds)
        told = {"method": method, "path": scope["path"], "status": status, "seconds": round(seconds, 4)}
        _log.info("%s %s %d", method, scope["path"], status, extra=told)


def _pattern(scope: Scope) -> str:
    """The pattern of the address: an address each would be numbers without end."""
    found = getattr(scope.get("route"), "path", "none")  # without the prefix under which its router was included
    return f"{API}{found}" if scope["path"].startswith(f"{API}/") and not found.startswith(API) else found

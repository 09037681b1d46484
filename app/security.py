"""Who may speak to the service: known hosts, own origin; how much; and what every answer carries."""

from __future__ import annotations

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.errors import Failure, problem, refusal
from app.settings import Settings

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; "
    "font-src 'self'; form-action 'self'; base-uri 'none'; frame-ancestors 'none'"
)
_HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "same-origin",  # without any a browser sends a form with the origin "null"
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
}


class Guard:
    """ASGI middleware: a request or socket passes all checks or ends here."""

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        self.app, self.settings = app, settings
        names = ("127.0.0.1", "localhost", "[::1]")
        self.hosts = {f"{name}:{settings.port}" for name in names} | set(names) | set(settings.allowed_hosts)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Check, then pass on."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        answer = self._refusal(headers)
        if answer is None:
            await self.app(scope, self._limited(receive), self._marked(send, scope["path"]))
        elif scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1008})
        else:
            await answer(scope, receive, self._marked(send, scope["path"]))

    def _refusal(self, headers: Headers) -> ASGIApp | None:
        host = headers.get("host", "")
        if host not in self.hosts:
            return problem(403, "unknown-host", f"host {host[:80]!r} is not served", "Host", "use the printed address")
        origin = headers.get("origin")
        if origin is not None and origin.partition("://")[2] not in self.hosts:
            return problem(
                403, "foreign-origin", "requests from other sites are refused", "Origin", "open the service's own page"
            )
        length = headers.get("content-length", "0")
        if not length.isdecimal() or int(length) > self.settings.largest_upload:
            return refusal(self._too_large("declared", "Content-Length"), connection="close")
        return None

    def _too_large(self, how: str, where: str) -> Failure:
        most = self.settings.largest_upload >> 20
        return Failure(
            413, "too-large", f"more than {most} MB are {how}", where, "upload fewer or shorter runs at a time"
        )

    def _limited(self, receive: Receive) -> Receive:
        """Count a body that declared no length; it is refused past the limit."""
        taken = 0

        async def limited() -> Message:
            nonlocal taken
            message = await receive()
            taken += len(message.get("body", b""))
            if taken > self.settings.largest_upload:
                raise self._too_large("sent", "body")
            return message

        return limited

    def _marked(self, send: Send, path: str) -> Send:
        async def marked(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in _HEADERS.items():
                    headers.setdefault(name, value)
                headers.setdefault("Cache-Control", "private, max-age=3600" if "/static/" in path else "no-store")
            await send(message)

        return marked

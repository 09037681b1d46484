"""A server that is told of events: it answers as it is bid, and keeps what came."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any


@dataclass
class Receiver:
    """Its address, the status that it answers with (None: it stays silent), and each request's headers and body."""

    port: int = 0
    status: int | None = 204
    location: str = ""
    came: list[tuple[dict[str, str], bytes]] = field(default_factory=list)
    ended: threading.Event = field(default_factory=threading.Event)

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}/told"

    @property
    def ids(self) -> list[str]:
        """Of the deliveries that came, in order."""
        return [headers["X-Servoident-Delivery"] for headers, _ in self.came]


@contextmanager
def receiver() -> Iterator[Receiver]:
    """One that listens on loopback, for the length of a block."""
    own = Receiver()

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            body = self.rfile.read(int(self.headers["Content-Length"]))
            own.came.append((dict(self.headers), body))
            if own.status is None:
                own.ended.wait()
                return
            self.send_response(own.status)
            if own.location:
                self.send_header("Location", own.location)
            self.end_headers()

        def log_message(self, *_: Any) -> None:
            """Nothing."""

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    own.port = server.server_address[1]
    thread = threading.Thread(target=server.serve_forever, args=(0.01,))
    thread.start()
    try:
        yield own
    finally:
        own.ended.set()
        server.shutdown()
        thread.join()
        server.server_close()

"""Requests to a running service, for the commands that are thin clients of it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any
from urllib.parse import quote
from uuid import uuid4

import typer

from app.cli.local_service import running
from ident.errors import Unusable

if TYPE_CHECKING:
    import ssl

    import httpx

Server = Annotated[
    str,
    typer.Option(
        metavar="URL",
        envvar="SERVOIDENT_SERVER",
        show_default=False,
        help="Address of the service (SERVOIDENT_SERVER); default: your service on this machine.",
    ),
]
Token = Annotated[
    str,
    typer.Option(
        metavar="TOKEN",
        envvar="SERVOIDENT_TOKEN",
        show_envvar=False,
        help="Token of the service (SERVOIDENT_TOKEN); not needed for your service on this machine.",
    ),
]
DEFAULT = ""
"""No address is given: the service that runs on this machine is meant."""
USUAL = "http://127.0.0.1:8000"
"""Where a service listens that was started without options."""
PATIENCE = 60.0  # s without an answer; fits are jobs, so nothing that is asked here takes longer


@cache
def _certificates() -> ssl.SSLContext:
    """The certificates that this machine trusts: 24 ms to read, once for all requests of a command."""
    import httpx

    return httpx.create_ssl_context()


def request(server: str, token: str, method: str, path: str, **content: Any) -> httpx.Response:
    """The answer of the service to one request. Raises Unusable where it refuses, or where there is none."""
    import httpx

    from app.client import start_command, without_number

    server, token = reached(server, token)
    headers = {"Idempotency-Key": str(uuid4())} if method == "POST" else {}
    if token:
        headers["Authorization"] = f"Bearer {token}"
    url = f"{server.rstrip('/')}/api/v1{path}"
    try:
        answer = httpx.request(method, url, headers=headers, timeout=PATIENCE, verify=_certificates(), **content)
    except UnicodeEncodeError:
        raise Unusable(
            "bad-token", "it is not plain ASCII", "--token", "give the token that the service printed"
        ) from None
    except (httpx.HTTPError, httpx.InvalidURL) as error:
        command = start_command(server)
        remedy = f"start it with {command}, or give another address with --server"
        raise Unusable("no-service", f"no answer from the service ({without_number(error)})", server, remedy) from None
    if answer.is_error:
        raise refusal(answer)
    return answer


def reached(server: str, token: str) -> tuple[str, str]:
    """Address and token of the service that is meant; what is not given is that of the one that runs here."""
    if server and token:
        return server, token
    here = running()
    if here is None:
        return server or USUAL, token
    if server.rstrip("/") in (DEFAULT, here.address):
        return here.address, token or here.token
    return server, token


def receive(server: str, token: str, path: str, file: Path) -> int:
    """The file that a POST is answered by, whole or not at all; its size in bytes. Raises Unusable."""
    import httpx

    from app.client import received, start_command, without_number

    server, token = reached(server, token)
    headers = {"Authorization": f"Bearer {token}"} if token else {}
    patience = httpx.Timeout(PATIENCE, read=None)  # it is made before the first byte comes
    try:
        with httpx.stream("POST", f"{server.rstrip('/')}/api/v1{path}", headers=headers, timeout=patience) as answer:
            if answer.is_error:
                answer.read()
                raise refusal(answer)
            return received(answer, file)
    except (httpx.HTTPError, httpx.InvalidURL) as error:
        command = start_command(server)
        raise Unusable(
            "no-service",
            f"no answer from the service ({without_number(error)})",
            server,
            f"start it with {command}, or give another address with --server",
        ) from None


def segment(name: str) -> str:
    """A name as one part of a path, whatever signs it holds."""
    return quote(name, safe="", errors="surrogateescape")


def refusal(answer: httpx.Response) -> Unusable:
    """The problem document of an answer as the error it is."""
    url = str(answer.request.url)
    try:
        problem = answer.json()
        return Unusable(problem["code"], problem["detail"], problem["where"] or url, problem["remedy"])
    except (ValueError, KeyError, TypeError):
        what = f"it answered {answer.status_code} {answer.reason_phrase}"
        return Unusable("no-service", what, url, "give the address of a servoident service with --server")


def items(server: str, token: str, path: str, params: Mapping[str, str]) -> Iterator[dict[str, Any]]:
    """Every entry of a list, page after page."""
    cursor: str | None = None
    while True:
        asked = dict(params) | ({"cursor": cursor} if cursor else {})
        page = request(server, token, "GET", path, params=asked).json()
        yield from page["items"]
        cursor = page.get("next")
        if cursor is None:
            return

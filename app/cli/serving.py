"""Running the service in this process, and doing something once it answers."""

from __future__ import annotations

import os
import socket
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING

from app.cli.local_service import announced
from ident.errors import Unusable

if TYPE_CHECKING:
    from app.settings import Settings

LOOPBACK = "127.0.0.1"
EVERYWHERE = ("0.0.0.0", "::")


def address(settings: Settings) -> str:
    """Where a client on this machine finds the service."""
    host = LOOPBACK if settings.host in EVERYWHERE else settings.host
    host = f"[{host}]" if ":" in host else host
    return f"http://{host}:{settings.port}"


def run(settings: Settings, once_ready: Callable[[], None]) -> None:
    """Serve until interrupted; `once_ready` runs in a thread as soon as the service answers.

    Raises Unusable where the address is in use or not this machine's.
    """
    check_free(settings.host, settings.port)
    from app.main import run as served

    threading.Thread(target=wait_and, args=(settings, once_ready), daemon=True).start()
    with announced(settings, address(settings)), suppress(KeyboardInterrupt):
        served(settings)
    print("stopped; unfinished jobs go on at the next start")


def wait_and(settings: Settings, act: Callable[[], None]) -> None:
    """Act when the port answers."""
    while True:
        try:
            socket.create_connection((settings.host, settings.port), timeout=1).close()
        except OSError:
            time.sleep(0.05)
        else:
            act()
            return


def check_free(host: str, port: int) -> None:
    """Raise Unusable where the service could not listen."""
    try:
        family, *_, place = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        with socket.socket(family) as trial:
            if os.name == "posix":  # a port that was just left is free; on Windows the option takes one that is in use
                trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            trial.bind(place)
    except (OSError, OverflowError) as error:
        what = getattr(error, "strerror", None) or str(error)
        raise Unusable("cannot-listen", what, f"{host}:{port}", "choose another --port, or stop what uses it") from None


def free_port(host: str, preferred: int) -> int:
    """The preferred port, or any other where it is taken."""
    try:
        check_free(host, preferred)
    except Unusable:
        with socket.socket() as trial:
            trial.bind((host, 0))
            return int(trial.getsockname()[1])
    return preferred

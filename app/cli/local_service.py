"""The service that runs on this machine: its address and start token, for the commands of the user who started it."""

from __future__ import annotations

import json
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

if TYPE_CHECKING:
    from app.settings import Settings

NAME = "service.json"
"""File in the data folder of a service that runs; only its user can read folder and file."""
DEMO = "demo"
"""Folder of the demonstration's data, in that of the service."""
_PATIENCE = 0.5  # s for a connection on this machine, which takes a millisecond


@dataclass(frozen=True)
class LocalService:
    """A service that runs: where it answers, its start token, and the process that serves."""

    address: str
    token: str
    process: int


@contextmanager
def announced(settings: Settings, address: str) -> Iterator[None]:
    """Within the block the commands of this user find the service."""
    settings.make_folders()
    path = settings.data / NAME
    path.unlink(missing_ok=True)
    with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", encoding="utf-8") as file:
        json.dump(asdict(LocalService(address, settings.token, os.getpid())), file)
    try:
        yield
    finally:
        if (there := _read(path)) is not None and there.process == os.getpid():
            path.unlink(missing_ok=True)


def running() -> LocalService | None:
    """The user's own service that runs on this machine, else the demonstration, else None."""
    from app.settings import default_data

    data = default_data()
    found = (_read(folder / NAME) for folder in (data, data / DEMO))
    return next((service for service in found if service is not None and _answers(service)), None)


def _read(path: Path) -> LocalService | None:
    with suppress(OSError, ValueError, TypeError):
        service = LocalService(**json.loads(path.read_text(encoding="utf-8")))
        if (type(service.address), type(service.token), type(service.process)) == (str, str, int):
            return service
    return None


def _answers(service: LocalService) -> bool:
    """Whether its process lives and its port answers: one that was killed leaves its file behind."""
    place = urlsplit(service.address)
    with suppress(OSError, ValueError, OverflowError):
        if os.name == "posix":
            os.kill(service.process, 0)
        socket.create_connection((place.hostname or "", place.port or 0), timeout=_PATIENCE).close()
        return True
    return False

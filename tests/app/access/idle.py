"""A service whose queue does no work: the engine of jobs is one a process, and the other tests have it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from app import main
from app.settings import Settings
from tests.running import TOKEN


class Idle:
    """Takes jobs and leaves them."""

    running = True

    def __init__(self, *_: Any) -> None:
        """As the engine is made."""

    def launch(self) -> None:
        """Nothing to start."""

    def submit(self, job: str) -> None:
        """It waits."""

    def stop(self) -> None:
        """Nothing to stop."""


def idle_app(folder: Path, token: str = TOKEN, **settings: Any) -> FastAPI:
    """The application with such settings."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(main, "Jobs", Idle)
        return main.create_app(Settings(data=folder, token=token, **settings))


@contextmanager
def idle(folder: Path, token: str = TOKEN, **settings: Any) -> Iterator[TestClient]:
    """A client of it."""
    app = idle_app(folder, token, **settings)
    with TestClient(app, "http://127.0.0.1:8000", raise_server_exceptions=False) as client:
        yield client

"""The service, a worker and a fit hold linear algebra to one thread for their life, also between jobs and drawings."""

from __future__ import annotations

import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from fastapi.testclient import TestClient

import ident
from app import main
from app.cli.worker import worker
from app.settings import Settings
from ident.progress import Progress
from tests.alone.test_parallel import OWN, notebook, threads

__all__ = ["notebook"]


@pytest.mark.usefixtures("notebook")
def test_the_service_from_its_start_to_its_end(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    seen: list[set[int]] = []
    for name in ("start", "stop"):
        monkeypatch.setattr(main, name, lambda *_: seen.append(threads()))
    settings = Settings(data=tmp_path)
    monkeypatch.setattr(main, "make_context", lambda *_: SimpleNamespace(settings=settings))
    with TestClient(main.create_app(settings)):
        seen.append(threads())
    assert seen == [{1}, {1}, {1}]
    assert threads() == {OWN}


@pytest.mark.usefixtures("notebook")
def test_a_worker_from_its_start_to_its_end(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[set[int]] = []

    def note(*_: object) -> None:
        seen.append(threads())

    def interrupted(*_: float) -> None:
        seen.append(threads())
        raise KeyboardInterrupt

    monkeypatch.setattr(main, "make_context", lambda *_: SimpleNamespace(jobs=SimpleNamespace(running=True)))
    for name in ("start", "stop"):
        monkeypatch.setattr(main, name, note)
    monkeypatch.setattr(sys.modules[worker.__module__], "time", SimpleNamespace(sleep=interrupted))
    worker("one", "postgresql://nobody@127.0.0.1:9/none")
    assert seen == [{1}, {1}, {1}]
    assert threads() == {OWN}


class Looked(Exception):
    """Enough was seen."""


@pytest.mark.usefixtures("notebook")
def test_a_fit_in_a_notebook_from_its_start_to_its_end() -> None:
    matrix = ident.simulate(seconds=0.25, small=True, seed=8)

    def look(_: Progress) -> None:
        assert threads() == {1}
        raise Looked

    with pytest.raises(Looked):
        ident.identify(matrix, report=look)
    assert threads() == {OWN}

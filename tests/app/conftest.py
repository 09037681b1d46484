"""A running service in the test's own process, with a small matrix from the independent reference."""

from __future__ import annotations

import hashlib
import io
import pickle
import sqlite3
import zipfile
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import fields
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alembic import command
from alembic.config import Config
from fastapi.testclient import TestClient
from sqlalchemy import make_url

from app import database
from app.main import create_app
from app.settings import Settings
from ident.checks import check as checks
from ident.checks.check import one_run
from ident.checks.delay import delay
from ident.checks.response import Response
from ident.matrix import Actuator
from ident.run import Run
from tests.conftest import short_searches
from tests.reference import qian_reference as reference
from tests.running import TOKEN

DESCRIPTION = """
actuator: {serial: SW-1, batch: B1, piston_area: 497 mm^2}
runs:
"""
RUN = """
  - id: %(id)s
    file: runs/%(id)s.npz
    sample_rate: 4096 Hz
    specimen: {mass: %(mass)g kg, stiffness: %(stiffness)g N/m, damping: 0 N*s/m}
    gain: %(gain)g
    kind: blwn
    use: %(use)s
    channels: {command: {column: command, unit: m}, displacement: {column: displacement, unit: m}}
"""


@lru_cache
def files(serial: str = "SW-1", more: bool = False) -> dict[str, bytes]:
    """Nine runs of half a second, or twelve: name → bytes."""
    trials = reference.trials()
    chosen = [*trials[::9], *trials[-2:]] if more else [*trials[:54:9], trials[63], *trials[-2:]]
    records = reference.measure_all(reference.Plant(), chosen, seconds=0.5, noise=0.005, seed=3, hold="linear")
    return packed(records, serial)


def packed(records: list[reference.Record], serial: str) -> dict[str, bytes]:
    """Records of the reference as the files of a matrix: name → bytes."""
    text, found = DESCRIPTION.replace("SW-1", serial), {}
    for record in records:
        cell = record.trial.cell
        text += RUN % {
            "id": record.trial.id,
            "mass": cell.mass,
            "stiffness": cell.stiffness,
            "gain": cell.gain,
            "use": record.trial.use,
        }
        buffer = io.BytesIO()
        np.savez(buffer, command=record.command, displacement=record.displacement)
        found[f"runs/{record.trial.id}.npz"] = buffer.getvalue()
    return {"matrix.yaml": text.encode(), **found}


@lru_cache
def zipped(serial: str = "SW-1", more: bool = False) -> bytes:
    """The same as one archive."""
    return archived(files(serial, more))


def unpacked(files: dict[str, bytes], folder: Path) -> Path:
    """The files in a folder."""
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    return folder


def archived(contents: dict[str, bytes]) -> bytes:
    """Files by name as one archive."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, content in contents.items():
            archive.writestr(name, content)
    return buffer.getvalue()


@pytest.fixture(scope="session", autouse=True)
def _empty_databases(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """The first database that is made passes through all revisions; those after it are copies, of SQLite's own kind."""
    upgrade, made = command.upgrade, tmp_path_factory.mktemp("empty") / "made.sqlite"

    def copied(config: Config, revision: str) -> None:
        url = make_url(config.attributes["url"])
        place = Path(url.database or ".")
        if url.get_backend_name() != "sqlite" or revision != "head" or place.exists():
            upgrade(config, revision)
            return
        if not made.exists():
            database.migrate(f"sqlite:///{made}", "heads")
        try:
            with closing(sqlite3.connect(made)) as old, closing(sqlite3.connect(place)) as new:
                old.backup(new)
        except sqlite3.Error:  # is said as the migration says it
            place.unlink(missing_ok=True)
            upgrade(config, revision)

    with pytest.MonkeyPatch.context() as own:
        own.setattr(command, "upgrade", copied)
        yield


@pytest.fixture(scope="package", autouse=True)
def _checked_once() -> Iterator[None]:
    """What the check says of one run is worked out once: many services are sent the same runs."""
    known: dict[str, Any] = {}

    def once(function: Callable[..., Any]) -> Callable[..., Any]:
        def answered(run: Run, response: Response | None, *of: Actuator) -> Any:
            values = [getattr(run, field.name) for field in fields(run)]
            key = hashlib.sha256(pickle.dumps((function.__name__, values, of))).hexdigest()
            if key not in known:
                known[key] = function(run, response, *of)
            return known[key]

        return answered

    with pytest.MonkeyPatch.context() as own:
        own.setattr(checks, "one_run", once(lambda *given: tuple(one_run(*given))))
        own.setattr("ident.checks.delay.delay", once(delay))
        yield


@pytest.fixture(scope="package", autouse=True)
def _short_searches(full: bool) -> Iterator[None]:
    """What is tested is what becomes of a fit, and not how it is found."""
    with short_searches(full):
        yield


@pytest.fixture(scope="package")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[TestClient]:
    """A client of a service with a folder of its own, for as long as tests of this folder follow one another."""
    settings = Settings(
        data=Path(tmp_path_factory.mktemp("service")), token=TOKEN, webhook_hosts=("127.0.0.1:9",), keep_raw=1
    )
    app = create_app(settings)
    headers = {"Authorization": f"Bearer {TOKEN}"}
    with TestClient(app, "http://127.0.0.1:8000", raise_server_exceptions=False, headers=headers) as client:
        yield client


@pytest.fixture(scope="package")
def matrix(service: TestClient) -> str:
    """The id of the uploaded matrix."""
    answer = service.post("/api/v1/matrices", files={"files": ("matrix.zip", zipped())})
    assert answer.status_code == 201, answer.text
    return str(answer.json()["id"])


@pytest.fixture(scope="package")
def fitted(service: TestClient, matrix: str) -> str:
    """The id of a finished fit."""
    job = service.post("/api/v1/fits", json={"matrix": matrix}).json()
    events = service.get(f"/api/v1/jobs/{job['id']}/events").text
    assert '"state":"succeeded"' in events, events[-2000:]
    return str(job["id"])


def reached(service: TestClient, job: str, text: str) -> None:
    """Wait until a job's events say so."""
    with service.stream("GET", f"/api/v1/jobs/{job}/events") as stream:
        assert any(text in line for line in stream.iter_lines())

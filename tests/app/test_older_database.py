"""The database of the version before: what it holds is read and shown, and what it left undone is done.

`tests/stored/before` was kept by the last version whose diagnoses were plain JSON (`tests/stored/keep_database.py`).
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.conftest import ROOT
from tests.running import Process, process

KEPT = ROOT / "tests" / "stored" / "before"
BEFORE: dict[str, Any] = json.loads((KEPT / "answers.json").read_text(encoding="utf-8"))
ANSWERS: dict[str, Any] = BEFORE["answers"]


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Process]:
    """A service on the data folder of the version before."""
    data: Path = tmp_path_factory.mktemp("before")
    for name in ("servoident", "queue"):
        with sqlite3.connect(data / f"{name}.sqlite") as database:
            database.executescript((KEPT / f"{name}.sql").read_text(encoding="utf-8"))
    for name, content in json.loads((KEPT / "blobs.json").read_text(encoding="utf-8")).items():
        blob = data / "blobs" / name[:2] / name
        blob.parent.mkdir(parents=True, exist_ok=True)
        blob.write_bytes(content.encode("utf-8"))
    with process(data) as running:
        yield running


def held(before: Any, now: Any, path: str = "") -> Iterator[str]:
    """Where an answer does not say what it said before; it may say more."""
    if isinstance(before, dict) and isinstance(now, dict):
        for name, value in before.items():
            yield from held(value, now[name], f"{path}.{name}") if name in now else [f"{path}.{name} is missing"]
    elif isinstance(before, list) and isinstance(now, list) and len(before) == len(now):
        for number, (one, other) in enumerate(zip(before, now, strict=True)):
            yield from held(one, other, f"{path}[{number}]")
    elif before != now:
        yield f"{path}: {before!r} is {now!r}"


@pytest.mark.parametrize("path", [path for path in ANSWERS if not path.startswith("/actuators")])
def test_what_is_stored_is_read_as_before(service, path):
    answer = service.client.get(path)
    assert answer.status_code == 200, answer.text
    assert list(held(ANSWERS[path], answer.json())) == []


def test_its_pages_and_figures_are_shown(service):
    """The fit with its value of the time constant, the diagnosis with what it found."""
    page = service.client.get(f"{service.address}/fits/{BEFORE['fit']}")
    assert page.status_code == 200
    assert "3.614" in page.text
    assert "dead zone" in page.text.lower()
    for figure in ("time", "evolution", "residual-map"):
        assert service.client.get(f"/fits/{BEFORE['fit']}/figures/{figure}.svg").status_code == 200


def test_a_fit_that_was_killed_in_its_search_ends_as_the_one_that_was_not(service):
    """It was asked for alike: two blocks of its search are of the version before."""
    job = service.ended(BEFORE["killed"])
    assert job["state"] == "succeeded", job
    whole = ANSWERS[f"/fits/{BEFORE['fit']}"]["result"]
    found = service.client.get(f"/fits/{job['fit']}").json()["result"]
    assert found["evolution"] == whole["evolution"]
    for name, before in whole["parameters"].items():
        assert found["parameters"][name]["value"] == pytest.approx(before["value"], rel=1e-6)


def test_a_diagnosis_that_waited_is_made_and_finds_the_same(service):
    job = service.ended(BEFORE["queued"])
    assert job["state"] == "succeeded", job
    before = ANSWERS[f"/diagnoses/{BEFORE['diagnosis']}"]
    found = service.client.get(f"/diagnoses/{job['diagnosis']}").json()
    assert found["verdict"]["effects"] == before["verdict"]["effects"] == ["dead_zone"]
    best = [one["candidates"][0] for one in (before, found)]
    assert best[0]["effect"] == best[1]["effect"]
    assert best[0]["error"]["fit"] == pytest.approx(best[1]["error"]["fit"], rel=1e-3)


def test_its_actuator_has_the_fit_that_was_left_undone_too(service):
    service.ended(BEFORE["killed"])
    found = service.client.get("/actuators/SW-1").json()
    assert found["serial"] == ANSWERS["/actuators/SW-1"]["serial"]
    assert found["fits"] == ANSWERS["/actuators/SW-1"]["fits"] + 1

"""Databases of earlier versions: what they hold is read and shown, and what they left undone is done.

`tests/stored/before` was kept by the last version whose diagnoses were plain JSON, `tests/stored/revision_0004` by the
last one with that schema, whose queue has the whole history of every job (`tests/stored/keep_database.py`). Both have
the same raw runs.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from tests.conftest import ROOT
from tests.running import FEW_EFFECTS, Process, process
from tests.short_form import short_form

STORED = ROOT / "tests" / "stored"
KEPT = STORED / "before"


@dataclass(frozen=True)
class Older:
    """A service on what an earlier version kept, and what that one said: answers by address, jobs by their fate."""

    running: Process
    said: dict[str, Any]

    @property
    def answers(self) -> dict[str, Any]:
        """What it answered."""
        found: dict[str, Any] = self.said["answers"]
        return found


@pytest.fixture(scope="module", params=short_form(["before", "revision_0004"], "before"))
def older(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, full: bool) -> Iterator[Older]:
    """Each of them, on a data folder of its own; in the short form four effects are ranked."""
    folder, data = STORED / request.param, Path(tmp_path_factory.mktemp("older"))
    for name in ("servoident", "queue"):
        with sqlite3.connect(data / f"{name}.sqlite") as database:
            database.executescript((folder / f"{name}.sql").read_text(encoding="utf-8"))
    for name, content in json.loads((KEPT / "blobs.json").read_text(encoding="utf-8")).items():
        blob = data / "blobs" / name[:2] / name
        blob.parent.mkdir(parents=True, exist_ok=True)
        blob.write_bytes(content.encode("utf-8"))
    with process(data, "" if full else FEW_EFFECTS) as running:
        yield Older(running, json.loads((folder / "answers.json").read_text(encoding="utf-8")))


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


def test_what_is_stored_is_read_as_before(older):
    for path, before in older.answers.items():
        if not path.startswith("/actuators"):
            answer = older.running.client.get(path)
            assert answer.status_code == 200, answer.text
            assert list(held(before, answer.json())) == [], path


def test_its_pages_and_figures_are_shown(older):
    """The fit with its value of the time constant, the diagnosis with what it found."""
    page = older.running.client.get(f"{older.running.address}/fits/{older.said['fit']}")
    assert page.status_code == 200
    assert "3.614" in page.text
    assert "dead zone" in page.text.lower()
    for figure in ("time", "evolution", "residual-map"):
        assert older.running.client.get(f"/fits/{older.said['fit']}/figures/{figure}.svg").status_code == 200


def test_a_fit_that_was_killed_in_its_search_ends_as_the_one_that_was_not(older):
    """It was asked for alike: two blocks of its search, five generations each, are of the version before.

    Since then a command that is sampled so finely is band-limited, and what lines lose of it is no part of a lag: what
    the search goes on to leaves less, with parameters near those.
    """
    job = older.running.ended(older.said["killed"])
    assert job["state"] == "succeeded", job
    whole = older.answers[f"/fits/{older.said['fit']}"]["result"]
    found = older.running.client.get(f"/fits/{job['fit']}").json()["result"]
    assert len(found["evolution"]) == len(whole["evolution"])
    assert found["evolution"][:10] == whole["evolution"][:10]
    assert found["error"]["fit"] < whole["error"]["fit"]
    for name, before in whole["parameters"].items():
        assert found["parameters"][name]["value"] == pytest.approx(before["value"], rel=0.05)


def test_a_diagnosis_that_waited_is_made_and_finds_the_same(older):
    job = older.running.ended(older.said["queued"])
    assert job["state"] == "succeeded", job
    before = older.answers[f"/diagnoses/{older.said['diagnosis']}"]
    found = older.running.client.get(f"/diagnoses/{job['diagnosis']}").json()
    assert found["verdict"]["effects"] == before["verdict"]["effects"] == ["dead_zone"]
    best = [one["candidates"][0] for one in (before, found)]
    assert best[0]["effect"] == best[1]["effect"]
    assert best[1]["error"]["fit"] == pytest.approx(best[0]["error"]["fit"], rel=0.03)
    assert best[1]["error"]["fit"] < best[0]["error"]["fit"]


def test_its_actuator_has_the_fit_that_was_left_undone_too(older):
    older.running.ended(older.said["killed"])
    found = older.running.client.get("/actuators/SW-1").json()
    assert found["serial"] == older.answers["/actuators/SW-1"]["serial"]
    assert found["fits"] == older.answers["/actuators/SW-1"]["fits"] + 1

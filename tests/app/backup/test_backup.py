"""A backup holds all there is, and a changed byte anywhere in it is named; restored, the service goes on."""

from __future__ import annotations

import random
import sqlite3
import time
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from app.backup.service import backup, restore
from app.cli.backup import said
from app.settings import Settings
from app.storage import Storage
from ident.errors import Unusable
from tests.app.test_older_database import KEPT
from tests.running import process

TABLES = ("actuators", "matrices", "jobs", "fits", "diagnoses", "evolutions", "idempotency")


def rows(data: Path) -> dict[str, list[Any]]:
    """What the tables hold, in any order."""
    with sqlite3.connect(data / "servoident.sqlite") as connection:
        return {name: sorted(map(repr, connection.execute(f"SELECT * FROM {name}"))) for name in TABLES}


class Kept(NamedTuple):
    """A backup of a running service, and what the tables held while it was made."""

    file: Path
    rows: dict[str, list[Any]]


@pytest.fixture(scope="module")
def made(service, fitted, tmp_path_factory) -> Kept:
    """A backup of a running service that has a fit; no job ran and no row changed while it was made.

    Jobs that other tests started may still end: the backup is made again until the tables read the same before and
    after it. A job that runs would be restored as one that waits.
    """
    settings = service.app.state.context.settings
    for number in range(60):
        if any(service.get("/api/v1/jobs", params={"state": at}).json()["items"] for at in ("queued", "running")):
            time.sleep(1.0)
            continue
        before = rows(settings.data)
        file = tmp_path_factory.mktemp("backup") / f"{number}.backup"
        held = backup(settings, file)
        if rows(settings.data) == before:
            break
        time.sleep(1.0)
    else:
        pytest.fail("the service was at work for a minute")
    assert fitted
    assert held.rows["fits"] >= 1
    assert held.blobs >= 1
    assert f"{held.rows['fits']} fits" in said(held)
    return Kept(file, before)


@pytest.fixture
def kept(made) -> Path:
    return made.file


def test_what_is_restored_is_what_was_there(service, fitted, made, tmp_path):
    """Every row but for the time at which it is restored, and every blob; and the service that starts on it answers."""
    here = Settings(data=tmp_path / "new")
    restore(here, made.file)
    there = service.app.state.context.settings.data
    assert rows(tmp_path / "new") == made.rows
    old, new = ({blob.sha256 for blob in Storage(data / "blobs").blobs()} for data in (there, tmp_path / "new"))
    assert new <= old
    assert new
    with process(tmp_path / "new") as running:
        answer = running.client.get(f"/fits/{fitted}/compare")
        assert answer.json()["runs"] == service.get(f"/api/v1/fits/{fitted}/compare").json()["runs"]


def test_a_flipped_byte_is_named_wherever_it_is(kept, tmp_path):
    """In a table, a blob or the frame; nothing is restored then."""
    content = bytearray(kept.read_bytes())
    draw, damaged = random.Random(20), tmp_path / "damaged"
    said = set()
    for place in [len(content) - 3, len(content) - 70, 40, *draw.sample(range(len(content)), 40)]:
        content[place] ^= 1 << draw.randrange(8)
        damaged.write_bytes(content)
        with pytest.raises(Unusable) as refused:
            restore(Settings(data=tmp_path / "none"), damaged)
        assert refused.value.code == "damaged-backup"
        said.add(" ".join(refused.value.what.split()[:3]))
        content[place] = kept.read_bytes()[place]
    assert {"damaged: the blob", "damaged: its frame,"} <= said
    damaged.write_bytes(content[: len(content) // 2])
    with pytest.raises(Unusable, match="or its end"):
        restore(Settings(data=tmp_path / "none"), damaged)
    assert not (tmp_path / "none").exists()


def test_a_backup_is_restored_into_nothing_else_than_an_empty_database(service, kept):
    with pytest.raises(Unusable, match="empty database") as refused:
        restore(service.app.state.context.settings, kept)
    assert refused.value.code == "not-empty"


def test_a_backup_of_the_version_before_is_brought_up_to_date(tmp_path):
    """Its database as that version left it, a job under way: restored, the job waits, and the schema is today's."""
    old = tmp_path / "old"
    old.mkdir()
    with sqlite3.connect(old / "servoident.sqlite") as database:
        database.executescript((KEPT / "servoident.sql").read_text(encoding="utf-8"))
        before = dict(database.execute("SELECT id, state FROM jobs"))
    assert "running" in before.values()
    backup(Settings(data=old), tmp_path / "file")
    restore(Settings(data=tmp_path / "new"), tmp_path / "file")
    with sqlite3.connect(tmp_path / "new" / "servoident.sqlite") as database:
        after = dict(database.execute("SELECT id, state FROM jobs WHERE fence = 0"))
    assert after == {job: "queued" if state == "running" else state for job, state in before.items()}


def test_migrate_says_its_steps_and_refuses_while_a_process_is_at_work(servoident, tmp_path):
    with sqlite3.connect(tmp_path / "servoident.sqlite") as database:
        database.executescript((KEPT / "servoident.sql").read_text(encoding="utf-8"))
    planned = servoident("migrate", "--plan", "--data", tmp_path)
    assert planned.returncode == 0, planned.stderr
    assert "0012: " in planned.stdout
    assert "would be done" in planned.stdout
    done = servoident("migrate", "--data", tmp_path)
    assert done.stdout.endswith("the database is up to date\n")
    assert "nothing is to be done" in servoident("migrate", "--plan", "--data", tmp_path).stdout

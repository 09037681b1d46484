"""The service and a worker beside it on PostgreSQL."""

from __future__ import annotations

import json
import time
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy.exc import DBAPIError

from app.database import connect, sessions
from app.settings import Settings
from app.tables import WebhookRow
from app.webhooks import repository as webhooks
from app.webhooks.key import key_of
from app.webhooks.outbox import announce
from schemas.webhooks import SetWithdrawn
from tests.app.test_idempotency import context_of, posts_at_once
from tests.app.test_own_effects import kept_at_once
from tests.app.webhooks.receiver import receiver
from tests.app.webhooks.test_webhooks import told_once
from tests.running import Service, command, free_port, nursery
from tests.running_postgresql import MISSING, SERVERS, postgresql

pytestmark = pytest.mark.skipif(not SERVERS, reason=MISSING)


@pytest.fixture(scope="module")
def database() -> Iterator[str]:
    """The URL of a new PostgreSQL server, which is gone after the tests."""
    with postgresql() as server:
        yield server.url


def test_processes_that_start_together_on_an_empty_database_make_it_once(database, tmp_path):
    """A service and its workers, brought up at one moment: one makes the tables, the others find them made."""
    migrate = ("migrate", "--database", database, "--data", str(tmp_path))
    errors = [tmp_path / f"errors-{number}" for number in range(3)]
    together = [nursery().start(tmp_path / "said", *migrate, stderr=to) for to in errors]
    assert [nursery().ended(process) for process in together] == [0, 0, 0]
    assert [said.read_text() for said in errors] == ["", "", ""]


def test_the_schema_is_made_and_made_again(servoident, database, tmp_path):
    """`migrate` brings an empty database up to date, and finds nothing to do the second time."""
    for _ in range(2):
        done = servoident("migrate", "--database", database, "--data", tmp_path)
        assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("change", ["UPDATE audit SET name = 'x'", "DELETE FROM audit", "TRUNCATE audit"])
def test_nobody_changes_the_audit(servoident, database, tmp_path, change):
    """The database refuses it; the line of a token that was made stays."""
    named = ("--database", database, "--data", tmp_path)
    assert servoident("token", "new", "--role", "ci", "--name", "audited", *named).returncode == 0
    engine = connect(database)
    with pytest.raises(DBAPIError, match="the audit is kept"), engine.begin() as connection:
        connection.exec_driver_sql(change)
    engine.dispose()
    assert "new_token" in servoident("audit", *named).stdout


def beside(database: str, name: str) -> str:
    """The URL of a new database of the same server."""
    engine = connect(database)
    with engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
        connection.exec_driver_sql(f"CREATE DATABASE {name}")
    engine.dispose()
    return f"{database.rpartition('/')[0]}/{name}"


def nothing_left(database: str) -> bool:
    """Whether the queue has, a moment after the last job, removed what it kept of each."""
    engine, deadline = connect(database), time.monotonic() + 30
    with engine.connect() as connection:
        while connection.exec_driver_sql("SELECT count(*) FROM dbos.operation_outputs").scalar():
            connection.rollback()
            if time.monotonic() > deadline:
                return False
            time.sleep(0.1)
    return True


def records(backup: Path) -> dict[str, Any]:
    """The tables of a backup with their hashes, and the names of its blobs, which are theirs."""
    with zipfile.ZipFile(backup) as archive:
        listed: dict[str, Any] = json.loads(archive.read("list.json"))
    return {"blobs": listed["blobs"], **listed["tables"]}


def test_a_service_and_a_worker_share_the_queue(servoident, database, few, tmp_path, full):
    """Fits of one matrix all end well, and an approved one is found by its serial number and rechecked."""
    place = ("--database", database, "--data", tmp_path)
    with (
        command("serve", "--port", free_port(), *place, until="token=") as line,
        command("worker", "--executor", "second", *place, until="waiting for jobs", anew=full),
    ):
        service = Service.that_said(line)
        nul = service.client.get("/actuators/%00")
        assert (nul.status_code, nul.json()["code"]) == (422, "unusable-text")  # SQLite would have looked for it
        stored = servoident("upload", few, *service.options)
        assert stored.returncode == 0, stored.stderr
        identity = stored.stdout.split()[1]
        short = {"population": 40, "generations": 6, "elite": 4}
        jobs = [service.fit(identity, seed=seed, options=short) for seed in (1, 2)]
        ended = [service.ended(job) for job in jobs]
        assert [job["state"] for job in ended] == ["succeeded", "succeeded"]
        assert servoident("approve", ended[0]["fit"], *service.options).returncode == 0
        assert ended[0]["fit"] in servoident("query", "--serial", "SIM-0001", *service.options, "--csv", "-").stdout
        assert nothing_left(database)
        assert servoident("backup", tmp_path / "all", *place).returncode == 0  # while it runs
    lite, again = tmp_path / "lite", tmp_path / "again"
    for moving in (("restore", tmp_path / "all", "--data", lite), ("backup", again, "--data", lite)):
        moved = servoident(*moving)
        assert moved.returncode == 0, moved.stderr
    assert records(again) == records(tmp_path / "all")
    back = ("--database", beside(database, "back"), "--data", tmp_path / "back")
    assert servoident("restore", again, *back).returncode == 0
    assert servoident("backup", tmp_path / "third", *back).returncode == 0
    assert records(tmp_path / "third") == records(again)
    done = servoident("regress", *place)
    assert done.returncode == 0, done.stdout + done.stderr


def test_simultaneous_posts_under_one_key_queue_one_job(database, tmp_path):
    """And of those that keep an own effect one is the first: as on SQLite; last, because nobody works on these jobs."""
    here = context_of(tmp_path, database)
    posts_at_once(here)
    kept_at_once(here)
    here.engine.dispose()


def test_a_webhook_is_told_once_by_several_processes(database, tmp_path):
    """Each of 24 deliveries once, in order, by three couriers on one database."""
    engine = connect(database)
    with receiver() as there:
        settings = Settings(data=tmp_path, database_url=database, webhook_hosts=(f"127.0.0.1:{there.port}",))
        key, origin = key_of(settings), f"http://127.0.0.1:{there.port}"
        with sessions(engine).begin() as session:
            session.add(WebhookRow(id="pg", url=there.url, origin=origin, events=["set.withdrawn"], key=key.print))
        ids = []
        for number in range(24):
            with sessions(engine).begin() as session:
                announce(session, SetWithdrawn, serial=f"PG-{number}", fit="f", who="", why="")
                ids.append(f"PG-{number}")
        told_once(sessions(engine), settings, there, 24)
        assert [json.loads(body)["serial"] for _, body in there.came] == ids
    with sessions(engine).begin() as session:
        webhooks.revoke(session, "pg", "")
    engine.dispose()

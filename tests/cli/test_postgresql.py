"""The service and a worker beside it on PostgreSQL."""

from __future__ import annotations

import os
import shutil
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.database import connect
from tests.app.test_idempotency import context_of, posts_at_once
from tests.app.test_own_effects import kept_at_once
from tests.running import Service, command, free_port

SERVERS = sorted(Path("/usr/lib/postgresql").glob("*/bin/pg_ctl"))
pytestmark = pytest.mark.skipif(not SERVERS, reason="PostgreSQL is not installed (apt-get install postgresql)")


def as_owner(*command: object) -> None:
    """Run a program of PostgreSQL, which refuses to run as root."""
    other = ["runuser", "-u", "postgres", "--"] if os.geteuid() == 0 else []
    done = subprocess.run([*other, *map(str, command)], cwd="/", capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.fixture(scope="module")
def database() -> Iterator[str]:
    """The URL of a new PostgreSQL server, which is gone after the tests."""
    folder = Path("/tmp") / f"servoident-pg-{os.getpid()}"  # short, for its socket; pytest's own is closed to others
    folder.mkdir(mode=0o700)
    if os.geteuid() == 0:
        shutil.chown(folder, "postgres")
    binaries, port = SERVERS[-1].parent, free_port()
    options = f"-p {port} -k {folder} -c listen_addresses=127.0.0.1 -c fsync=off"
    try:
        as_owner(binaries / "initdb", "-D", folder / "data", "-A", "trust", "-U", "postgres")
        as_owner(binaries / "pg_ctl", "-D", folder / "data", "-o", options, "-l", folder / "log", "-w", "start")
        yield f"postgresql://postgres@127.0.0.1:{port}/postgres"
        as_owner(binaries / "pg_ctl", "-D", folder / "data", "-m", "immediate", "stop")
    finally:
        shutil.rmtree(folder)


def test_the_schema_is_made_and_made_again(servoident, database, tmp_path):
    """`migrate` brings an empty database up to date, and finds nothing to do the second time."""
    for _ in range(2):
        done = servoident("migrate", "--database", database, "--data", tmp_path)
        assert done.returncode == 0, done.stderr


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


def test_a_service_and_a_worker_share_the_queue(servoident, database, matrix, tmp_path):
    """Fits of one matrix all end well, and an approved one is found by its serial number and rechecked."""
    place = ("--database", database, "--data", tmp_path)
    with (
        command("serve", "--port", free_port(), *place, until="token=") as line,
        command("worker", "--executor", "second", *place, until="waiting for jobs"),
    ):
        service = Service.that_said(line)
        nul = service.client.get("/actuators/%00")
        assert (nul.status_code, nul.json()["code"]) == (422, "unusable-text")  # SQLite would have looked for it
        stored = servoident("upload", matrix, *service.options)
        assert stored.returncode == 0, stored.stderr
        identity = stored.stdout.split()[1]
        jobs = [service.fit(identity, seed=seed) for seed in (1, 2)]
        ended = [service.ended(job) for job in jobs]
        assert [job["state"] for job in ended] == ["succeeded", "succeeded"]
        assert servoident("approve", ended[0]["fit"], *service.options).returncode == 0
        assert ended[0]["fit"] in servoident("query", "--serial", "SIM-0001", *service.options, "--csv", "-").stdout
        assert nothing_left(database)
    done = servoident("regress", *place)
    assert done.returncode == 0, done.stdout + done.stderr


def test_simultaneous_posts_under_one_key_queue_one_job(database, tmp_path):
    """And of those that keep an own effect one is the first: as on SQLite; last, because nobody works on these jobs."""
    here = context_of(tmp_path, database)
    posts_at_once(here)
    kept_at_once(here)
    here.engine.dispose()

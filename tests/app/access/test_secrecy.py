"""No token is anywhere but with its bearer: not in logs, not in the database, not in what an error says."""

from __future__ import annotations

import logging
import sqlite3
import subprocess
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy.exc import OperationalError

from app.access import repository
from app.backup.service import backup, restore
from app.catalogue import service as catalogue
from app.settings import Settings
from tests.app.access.idle import idle
from tests.app.access.table import API
from tests.running_postgresql import MISSING, SERVERS, postgresql

START = "the-start-token-of-an-operator"
OWN = ("httpx", "httpcore")  # what the test's own client logs


class Kept(logging.Handler):
    """Everything that any part of the program logs, at every level."""

    def __init__(self) -> None:
        super().__init__(logging.DEBUG)
        self.text = ""
        self.addFilter(lambda record: not record.name.startswith(OWN))
        self.setFormatter(logging.Formatter("%(name)s %(message)s"))

    def emit(self, record: logging.LogRecord) -> None:
        self.text += self.format(record) + "\n"


@pytest.fixture(scope="module")
def log() -> Iterator[Kept]:
    """Of the whole program, SQL statements with their values among it."""
    kept, root = Kept(), logging.getLogger()
    before = root.level
    root.addHandler(kept)
    root.setLevel(logging.DEBUG)
    logging.getLogger("sqlalchemy.engine").setLevel(logging.DEBUG)
    yield kept
    root.removeHandler(kept)
    root.setLevel(before)
    logging.getLogger("sqlalchemy.engine").setLevel(logging.NOTSET)


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder: Path = tmp_path_factory.mktemp("secrecy")
    return folder


@pytest.fixture(scope="module")
def said(log: Kept, data: Path) -> str:
    """What a service answered while tokens were made, shown in every way, refused, and while it failed."""
    told = [log.text]
    with (
        idle(data, START, failures=0, webhook_hosts=("hook.example",)) as client,
        pytest.MonkeyPatch.context() as patch,
    ):

        def ask(method: str, path: str, bearer: str = "", **content: object) -> None:
            headers = {"Authorization": f"Bearer {bearer}"} if bearer else {}
            answer = client.request(method, path, headers=headers, **content)  # type: ignore[arg-type]
            told.append(f"{answer.url.path} {answer.status_code} {answer.text}")

        body = {"name": "station", "role": "admin"}
        made = client.post(
            f"{API}/tokens", json=body, headers={"Authorization": f"Bearer {START}", "Idempotency-Key": "k"}
        )
        token = made.json()["token"]
        hook = {"url": "https://hook.example/", "events": ["limit.broken"]}
        secret = client.post(f"{API}/webhooks", json=hook, headers={"Authorization": f"Bearer {START}"}).json()[
            "secret"
        ]
        client.get(f"/?token={START}")
        client.cookies.clear()
        client.post("/sign-in", data={"token": token})
        SECRETS[:] = [START, token, token.partition(".")[2], secret, client.cookies["servoident"].partition(".")[2]]
        ask("GET", "/tokens")
        ask("POST", "/sign-in", data={"token": token + "x"})
        ask("GET", f"/jobs?token={token}x")
        client.cookies.clear()
        ask("GET", f"{API}/models", bearer=token + "x")
        ask("GET", f"{API}/tokens", bearer=token)
        ask("GET", f"{API}/nothing", bearer=token)
        ask("POST", f"{API}/fits", bearer=token, json={"matrix": 1})
        ask("POST", f"{API}/tokens", bearer=token, json=body)
        patch.setattr(catalogue, "models", lambda: 1 / 0)
        ask("GET", f"{API}/models", bearer=token)
        patch.setattr(repository, "token", _no_database)
        ask("GET", f"{API}/effects", bearer=token)
    return "\n".join(told)


SECRETS: list[str] = []
"""What may not be found; made with the service."""


def _no_database(_: object, token: str) -> None:
    raise OperationalError("SELECT a token", {"id": token}, Exception("no answer"))


def test_what_went_wrong_does_not_say_a_token(said: str) -> None:
    assert [status in said for status in (" 401 ", " 404 ", " 422 ", " 500 ", " 503 ")] == [True] * 5
    for answer in said.splitlines():
        if not answer.startswith(f"{API}/tokens 201"):  # whoever makes a token is told it, once
            assert [secret for secret in SECRETS if secret in answer] == []


def test_no_log_at_any_level_says_one(said: str, log: Kept) -> None:
    """Defects are logged with their traceback, statements with their values."""
    assert said
    assert "ZeroDivisionError" in log.text
    assert "INSERT INTO tokens" in log.text
    assert [secret for secret in SECRETS if secret in log.text] == []


def test_no_file_of_the_service_and_no_dump_holds_one(said: str, data: Path) -> None:
    """The database, its write-ahead log, the queue, and what a dump of them has; hashes alone are there."""
    assert said
    files = [path for path in data.rglob("*") if path.is_file()]
    with sqlite3.connect(data / "servoident.sqlite") as database:
        dump = "\n".join(database.iterdump())
    assert dump.count('INSERT INTO "tokens"') == 2
    assert files
    for secret in SECRETS:
        assert secret not in dump
        assert [path.name for path in files if secret.encode() in path.read_bytes()] == []


def test_no_backup_holds_one(said: str, data: Path, tmp_path: Path) -> None:
    """Neither as it is nor unpacked; nor the key of webhooks, or what is made of it."""
    assert said
    backup(Settings(data=data, token=START), tmp_path / "all.backup")
    with zipfile.ZipFile(tmp_path / "all.backup") as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    assert b"station" in parts["records/tokens.jsonl"]
    assert b"hook.example" in parts["records/webhooks.jsonl"]
    content = b"\n".join([(tmp_path / "all.backup").read_bytes(), *parts.values()])
    found = [secret for secret in [*map(str.encode, SECRETS), (data / "webhook.key").read_bytes()] if secret in content]
    assert found == []


@pytest.mark.full
@pytest.mark.skipif(not SERVERS, reason=MISSING)
def test_no_dump_of_postgresql_holds_one(said: str, data: Path, tmp_path: Path) -> None:
    """As pg_dump writes it, of the same records."""
    assert said
    backup(Settings(data=data, token=START), tmp_path / "all.backup")
    with postgresql() as server:
        restore(Settings(data=tmp_path / "new", database_url=server.url), tmp_path / "all.backup")
        command = [str(server.binaries / "pg_dump"), server.url]
        dump = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert "station" in dump
    assert "hook.example" in dump
    assert [secret for secret in SECRETS if secret in dump] == []


def test_settings_do_not_say_theirs() -> None:
    """Not where they are printed, as a traceback may."""
    assert START not in repr(Settings(token=START, database_url=f"postgresql://me:{START}@host/name"))

"""Whatever is wrong with an input, the service and the command line say so in the same words and keep nothing of it."""

from __future__ import annotations

import errno
import io
import os
import sqlite3
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import pytest
from fastapi.testclient import TestClient
from sqlalchemy import event, text

from app.cli.failures import report
from tests.app.conftest import zipped
from tests.bad_inputs import BAD_FOLDERS, BAD_MATRICES, Bad
from tests.conftest import Program
from tests.matrix_folder import MatrixFolder

PATIENCE = 60.0  # s, for jobs of other tests


@dataclass(frozen=True)
class BadSetting:
    """A setting of a fit that cannot be: as JSON, as options of the command, and the code by which it is refused."""

    name: str
    code: str
    json: dict[str, object]
    options: tuple[str, ...]


BAD_SETTINGS = (
    BadSetting("unknown model", "unknown-model", {"model": "linear"}, ("--model", "linear")),
    BadSetting("unknown effect", "unknown-effect", {"effects": ["magic"]}, ("--effect", "magic")),
    BadSetting("unknown method", "unknown-method", {"method": "newton"}, ("--method", "newton")),
    BadSetting("unknown load", "unknown-load", {"load": "sideways"}, ("--load", "sideways")),
    BadSetting("unknown option", "unknown-option", {"options": {"colour": 1}}, ("--option", "colour=1")),
    BadSetting("unknown parameter", "unknown-parameter", {"set": {"Z9": 1}}, ("--set", "Z9=1")),
    BadSetting(
        "bounds the wrong way round",
        "empty-bounds",
        {"bounds": {"tau": ["5 ms", "1 ms"]}},
        ("--bounds", "tau=5 ms:1 ms"),
    ),
    BadSetting(
        "bounds in a wrong unit",
        "wrong-dimension",
        {"bounds": {"tau": ["1 mm", "5 mm"]}},
        ("--bounds", "tau=1 mm:5 mm"),
    ),
    BadSetting("a value out of range", "not-finite", {"set": {"tau": "1e999 s"}}, ("--set", "tau=1e999 s")),
    BadSetting("a value that is no number", "not-a-quantity", {"set": {"tau": "nan"}}, ("--set", "tau=nan")),
)


@pytest.fixture
def folder(tmp_path: Path) -> MatrixFolder:
    """A good matrix, to be spoiled."""
    return MatrixFolder(tmp_path / "matrix")


def kept(service: TestClient) -> tuple[list[Path], dict[str, int]]:
    """Every stored file, and the numbers of records, once no job of another test stores its result any more."""
    context = service.app.state.context
    ends = time.monotonic() + PATIENCE
    with context.engine.connect() as connection:
        working = text("SELECT count(*) FROM jobs WHERE state IN ('queued', 'running')")
        while connection.execute(working).scalar_one() and time.monotonic() < ends:
            connection.rollback()
            time.sleep(0.05)
    with context.engine.connect() as connection:
        tables = ("actuators", "matrices", "jobs")
        counts = {table: connection.execute(text(f"SELECT count(*) FROM {table}")).scalar_one() for table in tables}
    return sorted(path for path in context.storage.folder.rglob("*") if path.is_file()), counts


def send(service: TestClient, content: bytes) -> httpx.Response:
    return service.post("/api/v1/matrices", files={"files": ("matrix.zip", content)})


def refused_by_service(answer: httpx.Response, code: str, status: int = 422) -> str:
    """A problem document that says what, where and the remedy; gives the what."""
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    problem = answer.json()
    assert problem["code"] == code, problem
    assert all(problem[name] for name in ("detail", "where", "remedy")), problem
    return str(problem["detail"])


def refused_by_command(done: Any) -> str:
    """One line on standard error that says what, where and the remedy; exit status 2."""
    assert done.returncode == 2, done.stderr
    assert done.stdout == ""
    (line,) = done.stderr.splitlines()
    assert line.startswith("servoident: ")
    assert line.partition(": ")[2].count(": ") >= 1
    assert "; " in line
    return str(line)


@pytest.mark.parametrize("bad", BAD_MATRICES, ids=lambda bad: bad.name)
def test_a_bad_matrix_is_refused_by_both(
    bad: Bad, service: TestClient, servoident: Program, folder: MatrixFolder
) -> None:
    path = bad.make(folder)
    before = kept(service)
    said = refused_by_service(send(service, (folder.pack() if path.is_dir() else path).read_bytes()), bad.code)
    assert kept(service) == before
    assert said in refused_by_command(servoident("check", path))
    assert not (folder.path.parent / "sprung").exists()


@pytest.mark.parametrize("bad", BAD_FOLDERS, ids=lambda bad: bad.name)
def test_what_only_a_disk_can_hold_is_refused_before_it_is_sent(
    bad: Bad, servoident: Program, folder: MatrixFolder
) -> None:
    """`upload` sends no file that `check` would not read: a link may lead to what nobody meant to send."""
    path = bad.make(folder)
    assert refused_by_command(servoident("upload", path)) == refused_by_command(servoident("check", path))


@pytest.mark.parametrize(
    "bad",
    [b for b in BAD_MATRICES if b.code in ("outside-folder", "yaml-alias", "not-a-zip")],
    ids=lambda bad: bad.name,
)
def test_upload_refuses_what_names_other_files(bad: Bad, servoident: Program, folder: MatrixFolder) -> None:
    """No server is asked: it would have the file already when it refuses."""
    path = bad.make(folder)
    assert refused_by_command(servoident("upload", path)) == refused_by_command(servoident("check", path))


@pytest.mark.parametrize("bad", BAD_SETTINGS, ids=lambda bad: bad.name)
def test_a_fit_that_cannot_be_is_refused_by_both(
    bad: BadSetting, service: TestClient, servoident: Program, folder: MatrixFolder, matrix: str
) -> None:
    before = kept(service)
    refused_by_service(service.post("/api/v1/fits", json={"matrix": matrix} | bad.json), bad.code)
    assert kept(service) == before
    refused_by_command(servoident("fit", folder.write(), *bad.options))


@pytest.mark.parametrize(
    ("body", "status", "code"),
    [
        (b'{"matrix": "MATRIX", "set": {"tau": NaN}}', 422, "invalid-request"),
        (b'{"matrix": "MATRIX", "bounds": {"tau": [0, Infinity]}}', 422, "invalid-request"),
        (b'{"matrix": "MATRIX", "options": {"generations": 1e999}}', 422, "invalid-request"),
        (b'{"matrix": "MATRIX", "set": {"tau": true}}', 422, "invalid-request"),
        (b'{"matrix": "MATRIX", "set": {"\\ud800": []}}', 422, "invalid-request"),
        (b'{"matrix": "\\ud800"}', 422, "unusable-text"),
        (b'{"matrix": "MATRIX", "seed": -1}', 422, "invalid-request"),
        (b'{"matrix": "MATRIX", "surprise": 1}', 422, "invalid-request"),
        (b'{"matrix": "no such"}', 404, "no-such-matrix"),
        (b'{"matrix": ', 422, "invalid-request"),
        (b"[" * 100_000, 400, "http-400"),
        (b"\xff", 400, "http-400"),
    ],
)
def test_a_body_that_is_no_request_is_refused(
    service: TestClient, matrix: str, body: bytes, status: int, code: str
) -> None:
    before = kept(service)
    sent = body.replace(b"MATRIX", matrix.encode())
    answer = service.post("/api/v1/fits", content=sent, headers={"Content-Type": "application/json"})
    refused_by_service(answer, code, status)
    assert kept(service) == before


@pytest.mark.parametrize(
    ("change", "code"),
    [
        ({"actuator": {"notes": [[[[[[[[[[[[[[1]]]]]]]]]]]]]]}}, "too-deep"),
        ({"actuator": {"serial": "S" * 201}}, "too-long"),
        ({"actuator": {"serial": None}}, "missing-field"),
        ({"runs": {"no such": {}}}, "unknown-run"),
    ],
)
def test_a_revision_that_cannot_be_is_refused(
    service: TestClient, matrix: str, change: dict[str, object], code: str
) -> None:
    before = kept(service)
    refused_by_service(service.post(f"/api/v1/matrices/{matrix}/revisions", json=change), code)
    assert kept(service) == before


def test_files_of_a_form_stay_below_the_matrix_and_have_names_of_their_own(
    service: TestClient, folder: MatrixFolder
) -> None:
    description = ("files", ("matrix.yaml", (folder.describe() / "matrix.yaml").read_bytes()))
    before = kept(service)
    for other, code in (("../evil.csv", "outside-folder"), ("matrix.yaml", "duplicate-file")):
        answer = service.post("/api/v1/matrices", files=[description, ("files", (other, b"x"))])
        refused_by_service(answer, code)
    assert kept(service) == before


def test_more_than_was_declared_is_refused(service: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    """A body without a length is counted; 2 GB that are declared are refused unread."""

    def body() -> Iterator[bytes]:
        yield b'--x\r\nContent-Disposition: form-data; name="files"; filename="a.zip"\r\n\r\n'
        yield from (b"x" * 1000 for _ in range(20))

    declared = service.post("/api/v1/matrices", content=b"", headers={"Content-Length": str(2 << 30)})
    refused_by_service(declared, "too-large", 413)
    settings = service.app.state.context.settings
    monkeypatch.setitem(settings.__dict__, "largest_upload", 5000)  # frozen, and shared with the running service
    sent = service.post("/api/v1/matrices", content=body(), headers={"Content-Type": "multipart/form-data; boundary=x"})
    refused_by_service(sent, "too-large", 413)


def full(_: int) -> None:
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_a_full_disk_keeps_nothing_of_an_upload(service: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    before = kept(service)
    monkeypatch.setattr(os, "fsync", full)
    refused_by_service(send(service, zipped("SW-FULL")), "disk-full", 507)
    assert kept(service) == before


def test_a_full_database_keeps_nothing_of_an_upload(service: TestClient) -> None:
    """SQLite says it in its own way."""

    def no_page_more(connection: sqlite3.Connection, _: object) -> None:
        connection.execute("PRAGMA max_page_count=1")  # no less than there are

    engine = service.app.state.context.engine
    before = kept(service)
    engine.dispose()
    event.listen(engine, "connect", no_page_more)
    try:
        refused_by_service(send(service, zipped("SW-FULL")), "disk-full", 507)
    finally:
        event.remove(engine, "connect", no_page_more)
        engine.dispose()
    assert kept(service) == before


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full on this system")
def test_a_full_disk_is_one_line_on_the_command_line(servoident: Program, folder: MatrixFolder) -> None:
    path = folder.write()
    assert "/dev/full" in refused_by_command(servoident("check", path, "--json", "/dev/full"))
    with Path("/dev/full").open("w") as output:
        command = [sys.executable, "-m", "app.cli", "check", str(path)]
        done = subprocess.run(command, stdout=output, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert "No space left" in done.stderr


def test_a_reader_that_has_gone_is_no_error(capsys: pytest.CaptureFixture[str]) -> None:
    """`servoident query --csv - | head -1` ends as any program does whose output nobody reads."""
    assert report(BrokenPipeError(errno.EPIPE, "Broken pipe")) == 141
    assert capsys.readouterr().err == ""


def test_another_upload_under_the_same_key_is_refused(service: TestClient, matrix: str) -> None:
    """Also one of the same name and size."""
    content = zipped()
    other = content[:-1] + bytes([content[-1] ^ 1])
    for sent, status in ((content, 200), (content, 200), (other, 409)):
        headers = {"Idempotency-Key": "an upload"}
        answer = service.post("/api/v1/matrices", files={"files": ("a.zip", io.BytesIO(sent))}, headers=headers)
        assert answer.status_code == status
        assert status != 200 or answer.json()["id"] == matrix


def test_an_upload_that_memory_does_not_hold_is_refused(service: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    """The process that read it was ended for it: the service goes on, and says what to do."""

    def ended(*_: object, **__: object) -> None:
        raise MemoryError

    with monkeypatch.context() as without:
        without.setattr(service.app.state.context.readers, "call", ended)
        refused = service.post("/api/v1/matrices", files={"files": ("matrix.zip", zipped("SW-M"))})
    assert (refused.status_code, refused.json()["type"].rpartition(":")[2]) == (422, "out-of-memory"), refused.text
    assert service.post("/api/v1/matrices", files={"files": ("matrix.zip", zipped("SW-M"))}).status_code == 201

"""Bad input is refused in words, over HTTP and on the command line, and nothing of it is kept."""

from __future__ import annotations

import pytest

from tests.app.conftest import service  # noqa: F401  a fixture
from tests.cli.conftest import servoident  # noqa: F401  a fixture
from tests.refusals.bad import ARCHIVES, FOLDERS, folder, said


def refused_by_command(program, path):
    """One line that says what, where and remedy, exit status 2."""
    done = program("check", path)
    assert done.returncode == 2, done.stdout + done.stderr
    lines = [line for line in done.stderr.splitlines() if line.startswith("servoident: ")]
    assert len(lines) == 1
    assert "Traceback" not in done.stderr
    assert ";" in lines[0]


def refused_over_http(client, files):
    """A problem with code, detail and remedy; no actuator is there afterwards."""
    answer = client.post("/api/v1/matrices", files=files)
    assert 400 <= answer.status_code < 500, answer.text
    assert answer.headers["content-type"].startswith("application/problem+json")
    problem = answer.json()
    assert problem["code"]
    assert problem["detail"]
    assert problem["remedy"]
    assert client.get("/api/v1/actuators/BAD-1").status_code == 404


@pytest.mark.parametrize("fault", FOLDERS)
def test_a_bad_folder_is_refused_both_ways(fault, servoident, service, tmp_path):  # noqa: F811
    path = folder(tmp_path / "matrix")
    FOLDERS[fault](path)
    refused_by_command(servoident, path)
    loose = [("files", (str(file.relative_to(path)), file.read_bytes())) for file in path.rglob("*") if file.is_file()]
    refused_over_http(service, loose)


@pytest.mark.parametrize("fault", ARCHIVES)
def test_a_bad_archive_is_refused_both_ways(fault, servoident, service, tmp_path):  # noqa: F811
    path = tmp_path / "matrix.zip"
    path.write_bytes(ARCHIVES[fault])
    refused_by_command(servoident, path)
    refused_over_http(service, {"files": ("matrix.zip", ARCHIVES[fault])})


def test_a_symbolic_link_in_a_folder_is_refused(servoident, tmp_path):  # noqa: F811
    path = folder(tmp_path / "matrix")
    (path / "runs/run.npz").rename(tmp_path / "elsewhere.npz")
    (path / "runs/run.npz").symlink_to(tmp_path / "elsewhere.npz")
    refused_by_command(servoident, path)


@pytest.mark.parametrize("name", ["model", "effect", "method", "load"])
def test_an_unknown_choice_is_refused_both_ways(name, servoident, service, tmp_path):  # noqa: F811
    path, value = folder(tmp_path / "matrix"), "unheard-of"
    said("BAD-1", "GOOD-1")(path)
    done = servoident("fit", path, f"--{name}", value)
    assert done.returncode == 2
    assert done.stderr.startswith("servoident: ")
    loose = [("files", (str(file.relative_to(path)), file.read_bytes())) for file in path.rglob("*") if file.is_file()]
    matrix = service.post("/api/v1/matrices", files=loose).json()["id"]
    body = {"matrix": matrix, "effects": [value]} if name == "effect" else {"matrix": matrix, name: value}
    answer = service.post("/api/v1/fits", json=body)
    assert answer.status_code in (400, 422)
    assert answer.headers["content-type"].startswith("application/problem+json")
    assert service.get("/api/v1/jobs").json()["items"] == []

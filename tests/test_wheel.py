"""The wheel and the source archive hold what the program needs, and nothing else: it runs without the repository."""

from __future__ import annotations

import json
import os
import re
import site
import socket
import subprocess
import sys
import tarfile
import urllib.request
import zipfile
from pathlib import Path

import pytest

from tests.test_imports import ROOT

WINDOWS = os.name == "nt"
NEEDED = (
    "ident/py.typed",
    "app/py.typed",
    "schemas/py.typed",
    "migrations/env.py",
    "migrations/script.py.mako",
    "migrations/versions/0001_first.py",
    "app/pages/templates/base.html",
    "app/pages/static/style.css",
    "app/report/templates/report.typ",
)


@pytest.fixture(scope="module")
def built(tmp_path_factory) -> Path:
    """A folder with the source archive and the wheel that was built from it."""
    out = tmp_path_factory.mktemp("built")
    options = ["--quiet", "--no-build-isolation", "--python", sys.executable, "--out-dir", out]
    done = subprocess.run(
        [sys.executable, "-m", "uv", "build", *options], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return out


@pytest.fixture(scope="module")
def installed(built, tmp_path_factory, request) -> Path:
    """Where the programs of a clean environment are that has the wheel; with --full it has its dependencies anew."""
    home = tmp_path_factory.mktemp("clean")
    uv = [sys.executable, "-m", "uv"]
    subprocess.run([*uv, "venv", "--quiet", "--python", sys.executable, home], check=True)
    programs = home / ("Scripts" if WINDOWS else "bin")
    pip = [*uv, "pip", "install", "--quiet", "--system-certs", "--python", programs / "python"]
    if request.config.getoption("--full"):
        subprocess.run([*pip, "--require-hashes", "--requirement", ROOT / "requirements.lock"], check=True)
    else:  # the dependencies are those of these tests; what is installed beside them for editing is not followed
        (place,) = home.glob("Lib/site-packages" if WINDOWS else "lib/*/site-packages")
        (place / "dependencies.pth").write_text("\n".join(site.getsitepackages()))
    subprocess.run([*pip, "--no-deps", next(built.glob("*.whl"))], check=True)
    return programs


def call(programs: Path, folder: Path, *arguments: str) -> str:
    """What a command prints, run in a folder without the repository."""
    done = subprocess.run(
        [programs / "servoident", *arguments], cwd=folder, capture_output=True, text=True, check=False, env=alone()
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def alone() -> dict[str, str]:
    """An environment that does not lead back to the repository."""
    return {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}


def test_the_wheel_has_these_packages_and_what_they_read(built):
    names = zipfile.ZipFile(next(built.glob("*.whl"))).namelist()
    tops = {name.split("/")[0] for name in names}
    assert {top for top in tops if not top.endswith(".dist-info")} == {"ident", "app", "schemas", "migrations"}
    assert not [name for name in NEEDED if name not in names]
    source = {
        path.relative_to(ROOT).as_posix()
        for top in ("ident", "app", "schemas", "migrations")
        for path in (ROOT / top).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    assert not source - set(names)


def test_the_source_archive_brings_licence_and_readme_and_no_data(built):
    with tarfile.open(next(built.glob("*.tar.gz"))) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert {"LICENSE", "README.md", "pyproject.toml"} <= names
    assert not [name for name in names if re.search(r"\.(parquet|npz|h5|tdms)$", name)]


def test_the_program_says_its_version_and_completes_its_commands(installed, tmp_path):
    assert re.fullmatch(r"servoident \d+\.\d+\.\d+\n", call(installed, tmp_path, "--version"))
    asked = {"_SERVOIDENT_COMPLETE": "complete_bash", "COMP_WORDS": "servoident diag", "COMP_CWORD": "1"}
    done = subprocess.run(
        [installed / "servoident"], capture_output=True, text=True, env={**alone(), **asked}, check=False
    )
    assert done.stdout.split() == ["diagnose"]


SIMULATED_AND_FITTED = """
import contextlib, ident
from app.cli.program import main
for given in (["simulate", "demo", "--small", "--seconds", "0.25"], ["fit", "demo", "--json", "fit.json"]):
    with contextlib.suppress(SystemExit):
        main(given)
print(ident.__file__)
"""


@pytest.mark.full
def test_it_simulates_and_fits_without_the_repository(installed, tmp_path):
    """In one process: the version and the service, in tests of their own, start the program that is installed."""
    asked = [installed / "python", "-c", SIMULATED_AND_FITTED]
    done = subprocess.run(asked, cwd=tmp_path, env=alone(), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert Path(done.stdout.splitlines()[-1]).is_relative_to(installed.parent)
    assert json.loads((tmp_path / "fit.json").read_text())["error"]["fit"] < 0.01


@pytest.mark.full
def test_it_serves_with_its_own_migrations_pages_and_style(installed, tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    token = {"SERVOIDENT_TOKEN": "wheel"}
    server = subprocess.Popen(
        [installed / "servoident", "serve", "--port", str(port), "--data", tmp_path / "data"],
        cwd=tmp_path,
        env={**alone(), **token},
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert str(port) in server.stdout.readline()
        address = f"http://127.0.0.1:{port}"
        with urllib.request.urlopen(f"{address}/api/v1/health", timeout=30) as answer:
            assert answer.status == 200
        page = urllib.request.Request(f"{address}/", headers={"Authorization": "Bearer wheel"})
        with urllib.request.urlopen(page, timeout=30) as answer:
            assert b"servoident" in answer.read()
    finally:
        server.terminate()
        server.wait(30)


def test_the_image_asks_the_service_whether_it_is_well():
    """By the address that it listens on, which the test above asks too."""
    said = (ROOT / "Dockerfile").read_text()
    assert "HEALTHCHECK" in said
    assert "http://127.0.0.1:8000/api/v1/health" in said

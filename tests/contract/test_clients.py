"""Other people's generators make clients of docs/openapi.json without a warning, and one of them makes a fit.

They are fetched into environments of their own, for theirs do not go with that of the tests: with --full only.
"""

from __future__ import annotations

import importlib
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import pytest

from tests.app.conftest import zipped
from tests.conftest import ROOT
from tests.running import ENDED, WAIT, Process, process

DOCUMENT = ROOT / "docs" / "openapi.json"
PYTHON = (
    sys.executable,
    "-m",
    "uv",
    "tool",
    "run",
    "--system-certs",
    "--from",
    "openapi-python-client==0.29.1",
    "openapi-python-client",
)
TYPESCRIPT = ("npx", "--yes", "openapi-typescript@7.13.0")


def fetched(*command: str) -> None:
    """Skip, with the reason, where the short forms are run or a generator cannot be had."""
    if shutil.which(command[0]) is None:
        pytest.skip(f"{command[0]} is not installed (apt-get install npm)")
    done = subprocess.run([*command, "--version"], capture_output=True, text=True, check=False)
    if done.returncode:
        pytest.skip(f"{command[-1]} cannot be fetched: {done.stderr[-300:]}")


@pytest.fixture(scope="module")
def client(full: bool, tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The package that openapi-python-client makes."""
    if not full:
        pytest.skip("it fetches a generator: run with --full")
    fetched(*PYTHON)
    folder: Path = tmp_path_factory.mktemp("client")
    to = ["--path", str(DOCUMENT), "--output-path", str(folder / "generated_client"), "--meta", "none"]
    done = subprocess.run([*PYTHON, "generate", *to, "--fail-on-warning"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "warning" not in (done.stdout + done.stderr).lower()
    sys.path.insert(0, str(folder))
    yield "generated_client"
    sys.path.remove(str(folder))


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Process]:
    """A service in a process of its own."""
    with process(tmp_path_factory.mktemp("served")) as running:
        yield running


def test_a_python_client_uploads_fits_and_reads_the_result(client: str, service: Process) -> None:
    """Every answer is an object of the client; a refusal is a Problem with what, where and the remedy."""

    def of(module: str) -> Any:
        return importlib.import_module(f"{client}.{module}")

    me = of("client").AuthenticatedClient(service.address, token=service.token, timeout=60)
    file = of("types").File(payload=BytesIO(zipped()), file_name="matrix.zip")
    body = of("models").UploadMatrixBody(files=[file])
    matrix = of("api.matrices.upload_matrix").sync(client=me, body=body)
    job = of("api.fits.start_fit").sync(client=me, body=of("models").FitRequest(matrix=matrix.id))
    deadline = time.monotonic() + WAIT
    while job.state not in ENDED and time.monotonic() < deadline:
        time.sleep(0.2)
        job = of("api.jobs.get_job").sync(job.id, client=me)
    assert job.state == "succeeded"
    fit = of("api.fits.get_fit").sync(job.id, client=me)
    raw = service.client.get(f"/fits/{job.id}").json()["result"]
    assert fit.result.parameters["tau"].value == raw["parameters"]["tau"]["value"]
    refused = of("api.fits.get_fit").sync("nothing", client=me)
    assert isinstance(refused, of("models").Problem)
    assert (refused.status, refused.code, refused.where) == (404, "no-such-fit", "fit")


def test_typescript_takes_the_document_too(full: bool, tmp_path: Path) -> None:
    if not full:
        pytest.skip("it fetches a generator: run with --full")
    fetched(*TYPESCRIPT)
    made = tmp_path / "api.d.ts"
    done = subprocess.run([*TYPESCRIPT, str(DOCUMENT), "-o", str(made)], capture_output=True, text=True, check=False)
    said = "".join(line for line in done.stderr.splitlines(keepends=True) if not line.startswith("npm "))
    assert done.returncode == 0, said
    assert "warn" not in (done.stdout + said).lower()
    assert "start_fit: {" in made.read_text(encoding="utf-8")

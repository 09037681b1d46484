"""A running service and Debian's chromium; screenshots are left in build/screenshots."""

from __future__ import annotations

import shutil
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import httpx
import pytest

from tests.app.conftest import TOKEN, zipped

CHROMIUM = "/usr/bin/chromium"
HERE = Path(__file__).resolve().parent
SCREENSHOTS = HERE.parents[1] / "build" / "screenshots"
SERVE = """
import sys
from pathlib import Path
from app.main import run
from app.settings import Settings
run(Settings(data=Path(sys.argv[1]), port=int(sys.argv[2]), token=sys.argv[3]))
"""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Skip, with the reason, where there is no browser."""
    if shutil.which(CHROMIUM):
        return
    reason = f"no browser: {CHROMIUM} does not exist (apt-get install chromium)"
    for item in items:
        if HERE in item.path.parents:
            item.add_marker(pytest.mark.skip(reason=reason))


@pytest.fixture(scope="session")
def browser_type_launch_args() -> dict[str, object]:
    quiet = ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update"]
    return {"executable_path": CHROMIUM, "args": [*quiet, "--disable-sync", "--no-first-run", "--disable-extensions"]}


@dataclass(frozen=True)
class Site:
    """A service as a process of its own, its address, and a client with the token."""

    address: str
    client: httpx.Client


def serve(data: Path) -> Iterator[Site]:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    process = subprocess.Popen([sys.executable, "-c", SERVE, str(data), str(port), TOKEN])
    address = f"http://127.0.0.1:{port}"
    client = httpx.Client(base_url=f"{address}/api/v1", headers={"Authorization": f"Bearer {TOKEN}"}, timeout=120)
    try:
        for _ in range(600):
            try:
                if client.get("/ready").status_code == 200:
                    break
            except httpx.TransportError:
                time.sleep(0.1)
        yield Site(address, client)
    finally:
        client.close()
        process.terminate()
        process.wait(20)


@pytest.fixture(scope="session")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Site]:
    """A service for all tests."""
    yield from serve(tmp_path_factory.mktemp("site"))


@pytest.fixture(scope="session")
def matrix(site: Site) -> str:
    """An uploaded matrix of nine runs."""
    answer = site.client.post("/matrices", files={"files": ("matrix.zip", zipped("SW/1 <b>"))})
    assert answer.status_code == 201, answer.text
    return str(answer.json()["id"])


@pytest.fixture(scope="session")
def fitted(site: Site, matrix: str) -> str:
    """A finished fit of it."""
    job = site.client.post("/fits", json={"matrix": matrix}).json()
    assert '"state":"succeeded"' in site.client.get(f"/jobs/{job['id']}/events").text
    return str(job["id"])


@dataclass
class Watch:
    """What the browser said and asked while a page was open."""

    complaints: list[str]
    requests: list[str]


@pytest.fixture
def watch(page, site) -> Iterator[Watch]:
    """Listens to the page, signed in; at the end nothing was complained of and nothing left the origin."""
    seen = Watch([], [])
    page.on("console", lambda message: seen.complaints.append(message.text) if message.type != "log" else None)
    page.on("pageerror", lambda error: seen.complaints.append(str(error)))
    page.on("request", lambda request: seen.requests.append(request.url))
    page.goto(f"{site.address}/?token={TOKEN}")
    yield seen
    assert seen.complaints == []
    foreign = [url for url in seen.requests if not url.startswith((site.address, "data:", "blob:"))]
    assert foreign == []


@pytest.fixture(scope="session")
def screenshots() -> Path:
    SCREENSHOTS.mkdir(parents=True, exist_ok=True)
    return SCREENSHOTS

"""A running service and Debian's chromium; with --full screenshots are left in build/screenshots."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from playwright.sync_api import Browser, ConsoleMessage, Page

from tests.app.conftest import zipped
from tests.browser.window import Window, hearing, signed_in
from tests.running import CHROMIUM, LITTLE, Service, process

HERE = Path(__file__).resolve().parent
SCREENSHOTS = HERE.parents[1] / "build" / "screenshots"


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Skip, with the reason, where there is no browser."""
    if shutil.which(CHROMIUM):
        return
    reason = f"no browser: {CHROMIUM} does not exist (apt-get install chromium-headless-shell)"
    for item in items:
        if HERE in item.path.parents:
            item.add_marker(pytest.mark.skip(reason=reason))


@pytest.fixture(scope="session")
def browser_type_launch_args() -> dict[str, object]:
    """Asks nothing elsewhere; pages of the one site share a process: one for each takes half of a short test.

    No page lives long enough for its scripts to be compiled a second time, for speed.
    """
    quiet = ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update"]
    quiet += ["--disable-sync", "--no-first-run", "--disable-extensions", "--js-flags=--no-opt"]
    shared = ["--process-per-site", "--renderer-process-limit=1", "--disable-site-isolation-trials"]
    return {"executable_path": CHROMIUM, "args": [*quiet, *shared]}


@pytest.fixture(scope="package")
def site(tmp_path_factory: pytest.TempPathFactory, full: bool) -> Iterator[Service]:
    """A service for all tests of this folder, no longer; in the short form with short searches and four effects."""
    with process(tmp_path_factory.mktemp("site"), "" if full else LITTLE) as service:
        yield service


@pytest.fixture(scope="package")
def matrix(site: Service) -> str:
    """An uploaded matrix of twelve runs."""
    answer = site.client.post("/matrices", files={"files": ("matrix.zip", zipped("SW/1 <b>", more=True))})
    assert answer.status_code == 201, answer.text
    return str(answer.json()["id"])


@pytest.fixture(scope="package")
def fitted(site: Service, matrix: str) -> str:
    """A finished fit of it."""
    job = site.fit(matrix)
    assert site.ended(job)["state"] == "succeeded"
    return job


@pytest.fixture
def running(site: Service, matrix: str) -> Iterator[str]:
    """A fit that searches for longer than any test takes; it is cancelled afterwards."""
    job = site.fit(matrix, seed=5, options={"generations": 10_000})
    yield job
    site.client.delete(f"/jobs/{job}")
    assert site.ended(job)["state"] == "cancelled"


@pytest.fixture(scope="package")
def window(
    launch_browser: Callable[..., Browser], browser_type_launch_args: dict[str, object], site: Service
) -> Iterator[Window]:
    """Where someone has signed in."""
    yield from signed_in(launch_browser, browser_type_launch_args, site)


@pytest.fixture
def page(window: Window) -> Iterator[Page]:
    """The page of the window; nothing that a test leaves in the browser is there for the next."""
    yield window.page
    window.clear()


@dataclass
class Watch:
    """What the browser said and asked while a page was open."""

    complaints: list[str]
    requests: list[str]


def complaint(message: ConsoleMessage) -> str:
    """What the browser's console said, and of which address."""
    return f"{message.text} {message.location['url']}"


@pytest.fixture(autouse=True)
def watch(page, site) -> Iterator[Watch]:
    """Listens to every test's page; at the end nothing was complained of and nothing left the origin."""
    seen = Watch([], [])
    heard = {
        "console": lambda message: seen.complaints.append(complaint(message)) if message.type != "log" else None,
        "pageerror": lambda error: seen.complaints.append(str(error)),
        "request": lambda request: seen.requests.append(request.url),
    }
    with hearing(page, heard):
        yield seen
    assert seen.complaints == []
    foreign = [url for url in seen.requests if not url.startswith((site.address, "data:", "blob:"))]
    assert foreign == []


@pytest.fixture(scope="session")
def screenshots(full: bool) -> Path | None:
    """Where pictures are left for whoever looks at them; a hundred of whole pages, so with --full only."""
    if not full:
        return None
    SCREENSHOTS.mkdir(parents=True, exist_ok=True)
    return SCREENSHOTS

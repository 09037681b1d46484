"""The documentation on the service's pages: every page opens, and no link or picture leads nowhere."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from app.pages import manual
from tests.app.access.idle import idle
from tests.running import TOKEN

HEADERS = {"Authorization": f"Bearer {TOKEN}"}
PAGES = [
    path.relative_to(manual.DOCS).with_suffix("").as_posix()
    for path in sorted(manual.DOCS.rglob("*.md"))
    if "_site" not in path.parts
]


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory):
    """A service that holds nothing."""
    with idle(tmp_path_factory.mktemp("manual"), rate=0, failures=0) as client:
        client.headers.update(HEADERS)
        yield client


def test_every_page_of_the_documentation_opens_and_leads_on(service: TestClient) -> None:
    """Each link inside it, with its place on the page, and each picture; only what Sphinx makes is left out."""
    texts = {name: answer.text for name in PAGES if (answer := service.get(f"/manual/{name}")).status_code == 200}
    assert set(PAGES) - texts.keys() == {"api"}
    lost = []
    for name, text in texts.items():
        article = text.partition("<article")[2].partition("</article>")[0]
        for target in re.findall(r'(?:href="|src=")((?<=src=")[^"]+|/manual/[^"]+)"', article):
            page, _, place = target.removeprefix("/manual/").partition("#")
            if page.endswith(tuple(manual.PICTURES)):
                if service.get(target).headers["content-type"] not in manual.PICTURES.values():
                    lost.append((name, target))
            elif page not in texts or (place and f'id="{place}"' not in texts[page]):
                lost.append((name, target))
    assert lost == []
    assert sum("<table" in text for text in texts.values()) > 10


def test_every_page_names_the_documentation(service: TestClient) -> None:
    assert '<a href="/manual/index">Help</a>' in service.get("/").text
    assert 'aria-current="page">Help</a>' in service.get("/manual/index").text


@pytest.mark.parametrize(
    "name", ["nothing", "../README", "..%2FREADME", "/etc/passwd", "pictures/none.png", "generate"]
)
def test_what_is_no_page_of_the_documentation_is_not_found(service: TestClient, name: str) -> None:
    assert service.get(f"/manual/{name}").status_code == 404


def test_without_the_documentation_beside_the_program_nothing_leads_there(
    service: TestClient, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """As in a wheel."""
    monkeypatch.setattr(manual, "DOCS", tmp_path)
    assert "/manual/" not in service.get("/").text
    assert service.get("/manual/index").status_code == 404


def test_a_comment_of_the_source_is_not_shown() -> None:
    """Pages that a program writes begin with one."""
    assert "<!--" in (manual.DOCS / "cli.md").read_text("utf-8")
    assert "&lt;!--" not in manual.manual_page(manual.DOCS / "cli.md").text

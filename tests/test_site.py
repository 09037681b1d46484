"""The documentation as a site: built without a warning, no link that is lost, a tutorial that does what it says."""

from __future__ import annotations

import html
import re
import shlex
from pathlib import Path
from urllib.parse import unquote, urldefrag

import numpy as np
import pytest

import ident
from docs.tutorial import parts, printed, record
from tests.running import nursery
from tests.test_docs import DOCS

NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
CLOSE = 0.02  # of a number that the tutorial prints: one in the last place of most


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    """The folder of the site, built anew as `python3 -m docs` builds it."""
    out, said = tmp_path_factory.mktemp("site"), tmp_path_factory.mktemp("said") / "errors"
    code = "import sys; from docs.build import built; sys.exit(built(sys.argv[1]))"
    number = nursery().start(
        said.with_name("output"), str(out), code=code, stderr=said
    )  # the program is imported there
    status, errors = nursery().ended(number), said.read_text(encoding="utf-8")
    assert status == 0, errors
    assert errors == ""
    return out


def links(page: Path) -> list[tuple[str, str]]:
    """The local links and pictures of a page: the file that each leads to, and the place in it."""
    found = re.findall(r'(?:href|src)="([^"]+)"', page.read_text(encoding="utf-8"))
    local = (html.unescape(link) for link in found if not re.match(r"(\w+:|//)", link))
    return [tuple(unquote(part) for part in urldefrag(re.sub(r"\?[^#]*", "", link))) for link in local]


@pytest.mark.full
def test_the_site_is_built_without_a_warning_and_no_link_leads_nowhere(site):
    pages = [page for page in site.rglob("*.html") if "_static" not in page.parts]
    places = {page: set(re.findall(r'\bid="([^"]+)"', page.read_text(encoding="utf-8"))) for page in pages}
    lost = []
    for page in pages:
        for name, place in links(page):
            target = (page.parent / name).resolve() if name else page
            if not target.exists() or (place and target in places and place not in places[target]):
                lost.append(f"{page.relative_to(site)}: {name}#{place}")
    assert len(pages) > 30
    assert not lost


@pytest.mark.full
def test_every_page_is_in_the_site_and_every_name_of_the_face_in_its_reference(site):
    written = {page.relative_to(DOCS).with_suffix(".html") for page in DOCS.rglob("*.md") if "_site" not in page.parts}
    assert not [str(page) for page in written if not (site / page).exists()]
    said = (site / "api.html").read_text(encoding="utf-8")
    assert not [name for name in ident.__all__ if f'id="ident.{name}"' not in said]


@pytest.mark.full
def test_a_picture_that_has_a_dark_form_is_shown_by_it_on_dark_pages(site):
    said = (site / "tutorial.html").read_text(encoding="utf-8")
    for picture in ("bode", "residual-correlation"):
        assert re.search(rf'<img[^>]*class="only-light"[^>]*tutorial-{picture}\.png', said)
        assert re.search(rf'<img[^>]*class="only-dark"[^>]*tutorial-{picture}-dark\.png', said)


def agree(found: str, said: str) -> None:
    """Assert that two texts have the same words, and numbers that are close."""
    assert NUMBER.sub("#", found).split() == NUMBER.sub("#", said).split()
    numbers = [np.array(NUMBER.findall(text), float) for text in (found, said)]
    np.testing.assert_allclose(*numbers, rtol=CLOSE)


def followed(blocks, full) -> int:
    """Run the blocks of Python, and compare what they print; how many did. What takes minutes runs with --full."""
    names, compared = {}, 0
    for block, after in zip(blocks, [*blocks[1:], None], strict=True):
        if block.kind == "python" and (full or not block.long):
            found = printed(block, names)
            if after is not None and after.kind == "text":
                agree(found, after.text)
                compared += 1
    return compared


@pytest.mark.full
def test_the_tutorial_on_the_measured_machine_does_what_it_says(measured_data, tmp_path, monkeypatch, full):
    """The record stands described as the page describes it; each block of Python is run."""
    record(tmp_path, measured_data / "mts_actuator" / "runs")
    monkeypatch.chdir(tmp_path)
    assert followed(parts()[0], full) >= 2


def test_the_tutorial_on_a_simulated_machine_does_what_it_says(servoident, tmp_path, monkeypatch, full):
    """Each command of the shell ends well, and the numbers are those of the page."""
    monkeypatch.chdir(tmp_path)
    for block in parts()[1]:
        for line in block.text.splitlines() if block.kind == "sh" else ():
            assert servoident(*shlex.split(line)[1:]).returncode == 0, line
    assert followed(parts()[1], full) == 1

"""What the program offers is in its documentation."""

from __future__ import annotations

import importlib.util
import re
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"


def generator():
    """The module docs/generate.py."""
    spec = importlib.util.spec_from_file_location("generate", DOCS / "generate.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


WRITTEN = ("cli.md", "criteria.md", "errors.md", "http.md", "models.md", "openapi.json")


@cache
def pages() -> dict[str, str]:
    """Every page that is generated; made by the worker that has these tests, not by each that collects them."""
    return generator().pages()


def test_every_generated_page_is_compared():
    assert {*pages()} == {*WRITTEN}


@pytest.mark.parametrize("name", WRITTEN)
def test_the_reference_pages_are_what_the_program_says(name):
    """Every command, option, model, effect and error code is on its page, as the source has it."""
    assert (DOCS / name).read_text(encoding="utf-8") == pages()[name], "run: .venv/bin/python docs/generate.py"


def test_every_command_of_the_contract_is_documented():
    """The names that scripts rely on are on the page of the command line."""
    promised = (
        "simulate check fit compare diagnose next bench report serve worker demo token migrate regress upload approve "
        "query revise effects track control hybrid whatif"
    )
    for command in promised.split():
        assert f"## servoident {command}" in pages()["cli.md"], command


def test_links_lead_somewhere():
    """No page links to a file that does not exist."""
    written = [*ROOT.glob("*.md"), *DOCS.rglob("*.md")]
    links = [(page, link) for page in written for link in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text())]
    assert links
    assert not [f"{page.relative_to(ROOT)}: {link}" for page, link in links if not (page.parent / link).exists()]


def test_the_readme_shows_the_two_commands_and_a_picture():
    """Whoever opens the project sees what it does and how to start it."""
    text = (ROOT / "README.md").read_text()
    assert "python3 -m app" in text
    assert "python3 -m tests" in text
    assert re.search(r"!\[[^\]]+\]\(docs/pictures/[^)]+\)", text)

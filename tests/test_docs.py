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


WRITTEN = ("cli.md", "criteria.md", "errors.md", "http.md", "models.md", "openapi.json", "diagnosis.md")


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


REFUSALS = """
def check(name, rows):
    what, remedy = f"row {len(rows)} is empty", "fill it"
    if name:
        what, remedy = f"no run {name!r}", did_you_mean(name, rows)
    raise Unusable("bad-run", what, "file", remedy)

def other(what):
    raise Failure(404, "no-run" if what else "no-file", "it is gone", "file", f"see {_LIST[0].title}")
"""


def test_the_table_of_errors_has_the_texts_that_were_chosen_before_and_the_names_of_their_values(tmp_path):
    """A text that depends on the case gives a row for each case."""
    file = tmp_path / "refusals.py"
    file.write_text(REFUSALS, encoding="utf-8")
    assert set(generator().codes(file)) == {
        ("`bad-run`", "422", "row {rows} is empty", "fill it"),
        ("`bad-run`", "422", "no run {name}", "did you mean {name}?, or the names to choose from"),
        ("`no-run`", "404", "it is gone", "see {title}"),
        ("`no-file`", "404", "it is gone", "see {title}"),
    }


def test_most_errors_are_in_the_table_with_their_text():
    """What another part of the program words, or a system call, has none: fewer than one in twenty."""
    rows = [row.split(" | ") for row in pages()["errors.md"].splitlines() if row.startswith("| `")]
    assert sum(row[2] == "…" for row in rows) < 0.05 * len(rows)


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

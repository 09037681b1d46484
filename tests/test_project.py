"""The gates of the whole project: lint, types, file sizes, what must not be in it."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
LONGEST = 500  # lines of a source file: it is cut where a concept ends, not at a line
WHOLE = {"tests/reference/nonlinear_reference.py"}  # one flat file on purpose: the whole model, to be read in one go
LONGEST_FUNCTION = 50  # lines of its body: a command's options are no part of its story
IN_ONE_GO = {
    "ident/fit/summary.py: summarise": "a fit's result is put together from a search, each part by a name of its own",
    "ident/bench/exact_response.py: respond_exact": "one compiled loop over the samples of a record",
    "app/pages/fit_page.py: fit_page": "what the page of a fit shows is put together, each part by a name of its own",
}
"""Longer functions whose story splitting would hide, each with the reason."""
TEXT = {".py", ".md", ".toml", ".lock", ".yaml", ".yml", ".html", ".css", ".js", ".mjs", ".ini", ".mako", ""}


TYPE_CHECKER = """import gc
gc.disable()
gc.enable = lambda: None
from mypy.__main__ import console_entry
console_entry()
"""
"""Mypy without Python's collector, which searches trees that only grow: a fifth of its time."""


def run(*arguments: str) -> None:
    """Run this Python in the checkout; fail with its output."""
    called = [sys.executable, *arguments]
    done = subprocess.run(called, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{' '.join(arguments)}\n{done.stdout}{done.stderr}"


def tracked() -> list[Path]:
    """The files under version control, and new ones that are not ignored."""
    listing = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    try:
        done = subprocess.run(listing, cwd=ROOT, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("not a git checkout: its files cannot be listed")
    return [path for line in done.stdout.splitlines() if (path := ROOT / line).is_file()]


def test_lint():
    """Ruff finds nothing."""
    run("-m", "ruff", "check", "--quiet", ".")


def test_format():
    """Every file is laid out as `ruff format` lays it out."""
    run("-m", "ruff", "format", "--check", "--quiet", ".")


def test_types(full):
    """Pyrefly finds nothing in the packages, and with --full nor does mypy in strict mode, which takes longer.

    What mypy knows of unchanged files, by their hash, is kept for every checkout of this user: all anew take a minute.
    """
    run("-m", "pyrefly", "check", "--output-format", "min-text", "--python-interpreter-path", sys.executable)
    if full:
        kept = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "servoident-tests"
        run("-c", TYPE_CHECKER, "--cache-dir", str(kept / "mypy"))


def test_source_files_are_short():
    """No Python file is longer than what a reader holds in mind."""
    lengths = {path: len(path.read_text(encoding="utf-8").splitlines()) for path in tracked() if path.suffix == ".py"}
    found = {str(path.relative_to(ROOT)): n for path, n in lengths.items() if n > LONGEST}
    assert not found.keys() - WHOLE


def statements(node: ast.AST) -> Iterator[ast.AST]:
    """The statements below a node, without the expressions in them, which hold no function: a fifth of the nodes."""
    for inner in (
        each for part in ("body", "orelse", "finalbody", "handlers", "cases") for each in getattr(node, part, ())
    ):
        yield inner
        yield from statements(inner)


def test_functions_are_short():
    """No function of the packages is longer than a screen, but for those that are a story told in one go."""
    found = {
        f"{path.relative_to(ROOT)}: {node.name}"
        for package in ("ident", "app", "schemas")
        for path in sorted((ROOT / package).rglob("*.py"))
        for node in statements(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
        and (node.end_lineno or 0) - node.body[0].lineno + 1 > LONGEST_FUNCTION
    }
    assert found == IN_ONE_GO.keys()


def test_nothing_names_the_machine_it_was_made_on():
    """No text file holds a path of somebody's checkout or home folder."""
    place = re.compile(r"(?<![\w./$}-])/(?:work|root|home/\w+|Users/\w+)/\w")
    texts = [path for path in tracked() if path.suffix in TEXT and path != Path(__file__)]
    found = [
        f"{path.relative_to(ROOT)}:{number}: {line.strip()[:100]}"
        for path in texts
        for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1)
        if place.search(line)
    ]
    assert not found


def test_the_lock_files_name_no_host_and_every_package_has_hashes():
    """Where packages come from is the choice of whoever installs them."""
    for name in ("requirements.lock", "requirements-tests.lock"):
        text = (ROOT / name).read_text()
        assert "://" not in text
        assert len(re.findall(r"^\S+==.*\\$", text, re.M)) == len(re.findall(r"^\S+==", text, re.M)) > 0


def test_the_tests_run_with_the_versions_that_the_service_runs_with():
    """Every pinned package of the service's lock file stands unchanged in the tests' lock file."""
    service, tests = ((ROOT / name).read_text() for name in ("requirements.lock", "requirements-tests.lock"))
    pinned = re.compile(r"^\S+==[^\\]+", re.M)
    assert not set(pinned.findall(service)) - set(pinned.findall(tests))


def test_the_lock_files_hold_what_the_project_asks_for():
    """A dependency added to pyproject.toml is in the lock files too."""
    import tomllib

    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    for name, extras in (("requirements.lock", ("setup",)), ("requirements-tests.lock", ("setup", "tests"))):
        locked = set(re.findall(r"^([\w.-]+)==", (ROOT / name).read_text(), re.M))
        asked = [*project["dependencies"], *(one for e in extras for one in project["optional-dependencies"][e])]
        wanted = {re.match(r"[\w.-]+", entry)[0].lower().replace("_", "-").replace(".", "-") for entry in asked}
        assert not wanted - locked


def test_the_walks_name_files_that_exist():
    """Three of them, ten lines each, and every file that they lead to is there."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    walks = text.partition("## Three walks")[2].partition("\n## ")[0]
    assert len(re.findall(r"^\d+\. ", walks, re.M)) == 30
    named = re.findall(r"`([a-z_]+/[\w/.]+)`", walks)
    assert len(named) > 40
    assert not [name for name in named if not (ROOT / name).is_file()]


@pytest.mark.parametrize(
    ("change", "most"),
    [
        ("add an effect", 5),
        ("change the rule by which an effect is added", 4),
        ("add a figure with an option", 5),
        ("change a field that an endpoint answers", 4),
        ("understand a verdict", 8),
    ],
)
def test_a_common_change_takes_few_files_to_read_and_they_exist(change, most):
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    read, touch = re.search(rf"^\| {change} \| (.+) \| (.*)\|$", text, re.M).groups()
    of_row = re.findall(r"`([a-z_]+/[\w/.]+)`", read)
    assert 0 < len(of_row) <= most
    assert not [name for name in (*of_row, *re.findall(r"`([a-z_]+/[\w/.]+)`", touch)) if not (ROOT / name).exists()]

"""What only the long form does is written down, and nothing that finds a mutation is among it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.mutations import MUTATIONS
from tests.short_form import short_form

TESTS = Path(__file__).resolve().parent
DECISION = TESTS.parent / "docs" / "decisions" / "tests.md"
MARKED = re.compile(r"mark\.full\b|\bshort_form\(\w|\bshort_form\(\[")
FUNCTION = re.compile(r"((?:^@.*\n)*)^def (test_\w+)\(", re.M)


def marked() -> dict[str, Path]:
    """Each file that has tests or cases of the long form alone, by its name in the table."""
    files = {path.relative_to(TESTS).with_suffix("").as_posix(): path for path in TESTS.rglob("test_*.py")}
    return {
        name: path
        for name, path in files.items()
        if path != Path(__file__).resolve() and MARKED.search(path.read_text(encoding="utf-8"))
    }


def test_each_file_with_long_forms_has_a_row():
    said = DECISION.read_text(encoding="utf-8")
    assert len(marked()) > 40
    assert not [name for name in marked() if f"`{name}" not in said]


def test_what_finds_a_mutation_is_in_the_short_form():
    """Tests that are named one by one; of a whole file some are left."""
    for test in {test for mutation in MUTATIONS for test in mutation.tests}:
        file, _, name = test.partition("::")
        functions = dict(reversed(found) for found in FUNCTION.findall((TESTS.parent / file).read_text("utf-8")))
        named = functions if not name else {name.partition("[")[0]: functions[name.partition("[")[0]]}
        assert any("mark.full" not in decorators for decorators in named.values()), test


def test_a_case_that_is_none_cannot_be_kept():
    first, second = short_form([("a", 1), ("b", 2)], ("b", 2))
    assert (first.values, [mark.name for mark in first.marks], second) == (("a", 1), ["full"], ("b", 2))
    with pytest.raises(ValueError, match="'c'"):
        short_form(["a", "b"], "c")

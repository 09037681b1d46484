"""Every number that decides in a diagnosis stands once, in the criteria, with unit, meaning, reason and its test."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import FrozenInstanceError, fields
from pathlib import Path

import pytest

from ident.diagnosis.criteria import CRITERIA
from tests.diagnosis.criteria_source import FILES, FOLDER, ROOT, documented, named_tests

FREE = {0, 1, 2, 0.5}
ELSEWHERE = {
    ("label_checks.py", 1.4826): "the deviation of a normal distribution over its median deviation (Hampel 1974)",
    ("label_checks.py", 1e3): "milliseconds of a second",
    ("sentences.py", 100): "per cent of a share",
    ("discovery/term_library.py", 3): "the power of a cube, in the unit of its term",
    ("discovery/term_library.py", 0.25): "a cosine is a sine a quarter of a turn later",
    ("discovery/regression.py", 4): "runs in memory together: the regression is that of all runs at once",
    ("discovery/regressors.py", 128): "terms in memory together: the regression is that of all terms at once",
    ("discovery/regressors.py", 32): "columns in the cache: each is to the bit what it is alone",
    ("candidate_models.py", 8): "lanes of a kernel: what an effect promises is the same alone",
    ("evidence/chance.py", 25): "surrogates in memory together: with another number other phases are drawn, as random",
}
"""Numbers that decide nothing, each with the reason why it stands where it is."""


def test_each_number_has_a_unit_a_meaning_a_reason_and_a_test_that_is_there():
    """`python -m tests.diagnosis.moved_criteria` moves each number and sees that test fail."""
    for name, test in named_tests().items():
        file, function = test.split("::")
        assert f"def {function}(" in (ROOT / "tests/diagnosis" / file).read_text(encoding="utf-8"), name


def test_every_section_is_part_of_the_criteria_and_none_can_be_changed():
    sections = [getattr(CRITERIA, one.name) for one in fields(CRITERIA)]
    count = sum(len(fields(section)) for section in sections)
    assert count == len([name for name, _ in documented() if not name.startswith(".")])
    with pytest.raises(FrozenInstanceError):
        CRITERIA.selection.most = 7


def test_every_number_decides_somewhere():
    """A number that nothing reads is gone."""
    source = "\n".join(file.read_text(encoding="utf-8") for file in (ROOT / "ident").rglob("*.py"))
    names = [one.name for section in fields(CRITERIA) for one in fields(getattr(CRITERIA, section.name))]
    assert not [name for name in names if not re.search(rf"\.{name}\b", source)]


def numbers_of(file: Path) -> Iterator[tuple[int, float]]:
    """Line and value of each number of a file that is no place in a sequence."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    places = {
        id(inner)
        for node in ast.walk(tree)
        if isinstance(node, ast.Subscript) or (isinstance(node, ast.Call) and "transpose" in ast.unparse(node.func))
        for part in ([node.slice] if isinstance(node, ast.Subscript) else node.args)
        for inner in ast.walk(part)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and type(node.value) in (int, float) and id(node) not in places:
            yield node.lineno, node.value


def test_no_number_decides_outside_of_the_criteria():
    """But zero, one, two and a half, and those of a formula or a unit that is cited."""
    assert len(list(numbers_of(FILES[0]))) > len(FREE)
    found = {
        (file.relative_to(FOLDER).as_posix(), value)
        for file in sorted(FOLDER.rglob("*.py"))
        if file not in FILES
        for _, value in numbers_of(file)
        if value not in FREE
    }
    assert found == ELSEWHERE.keys()

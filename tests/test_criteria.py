"""Every number that decides stands once, in the criteria of its room, with unit, meaning, reason and its test."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import FrozenInstanceError, fields
from typing import Any

import pytest

from ident.bench.criteria import BENCH_CRITERIA
from ident.diagnosis.criteria import CRITERIA
from ident.fit.criteria import FIT_CRITERIA
from ident.noise.criteria import NOISE_CRITERIA
from tests.criteria_source import ROOMS, ROOT, Room, documented

OF_ROOMS: dict[str, Any] = {
    "noise": NOISE_CRITERIA,
    "fit": FIT_CRITERIA,
    "diagnosis": CRITERIA,
    "bench": BENCH_CRITERIA,
}
FREE = {0, 1, 2, 0.5}
CITED = re.compile(r"\b(18|19|20)\d\d\b")
"""The year of a source: where a formula comes from."""
SIZE = "No answer depends on it"
"""What is written below a size that is a matter of memory or time alone, or below the factor of a unit."""
WITH_CRITERIA = [room for room in ROOMS if room.name in OF_ROOMS]


def test_each_number_has_a_unit_a_meaning_a_reason_and_a_test_that_is_there():
    """`python -m tests.moved_criteria` moves each number and sees that test fail."""
    for number in documented():
        file, function = number.test.split("::")
        assert f"def {function}(" in (ROOT / file).read_text(encoding="utf-8"), number.full_name


def test_no_two_numbers_have_one_name():
    assert not [name for name, count in Counter(number.full_name for number in documented()).items() if count > 1]


@pytest.mark.parametrize("room", WITH_CRITERIA, ids=lambda room: room.name)
def test_every_section_is_part_of_the_criteria_and_none_can_be_changed(room):
    criteria = OF_ROOMS[room.name]
    sections = [getattr(criteria, one.name) for one in fields(criteria)]
    count = sum(len(fields(section)) for section in sections)
    assert count == len([number for number in documented() if number.room == room and number.section])
    for section in sections:
        with pytest.raises(FrozenInstanceError):
            setattr(section, fields(section)[0].name, 7)


def test_every_number_decides_somewhere():
    """A number that nothing reads is gone."""
    source = "\n".join(file.read_text(encoding="utf-8") for file in (ROOT / "ident").rglob("*.py"))
    read = {*re.findall(r"\.(\w+)\b", source), *re.findall(r"\[\"(\w+)\"\]", source)}
    assert not [number.full_name for number in documented() if number.section and number.name not in read]


def deciding(source: str) -> Iterator[tuple[int, float]]:
    """Line and value of each number of a source text that is free of no rule.

    Free are 0, 1, 2 and ½, a place in a sequence, the shape of an array that is filled by place, a power that is
    written as one (the cube of a ratio), the digits of a text, what stands in a function whose docstring cites the
    source of its formula, or says that no answer depends on it, and a constant below which the same stands.
    """
    tree = ast.parse(source)
    free = {id(inner) for node in ast.walk(tree) for part in _free(node) for inner in ast.walk(part)}
    for node in ast.walk(tree):
        number = isinstance(node, ast.Constant) and type(node.value) in (int, float)
        if number and id(node) not in free and node.value not in FREE:
            yield node.lineno, node.value


def _free(node: ast.AST) -> Iterator[ast.AST]:
    """The parts of a node in which no number decides."""
    match node:
        case ast.Subscript(slice=place):
            yield place
        case ast.Call(func=ast.Attribute(attr="transpose" | "empty"), args=places):
            yield from places
        case ast.keyword(arg="digits"):
            yield node
        case ast.BinOp(op=ast.Pow(), right=ast.Constant(value=int()) as power):
            yield power
        case ast.FunctionDef() if _says_why(node.body[0]):
            yield node
        case ast.Module() | ast.ClassDef():
            for one, below in zip(node.body, node.body[1:], strict=False):
                if isinstance(one, ast.Assign | ast.AnnAssign) and _says_why(below):
                    yield one


def _says_why(node: ast.stmt) -> bool:
    match node:
        case ast.Expr(ast.Constant(value=str() as text)):
            said = " ".join(text.split())
            return SIZE in said or bool(CITED.search(said))
    return False


@pytest.mark.parametrize("room", WITH_CRITERIA, ids=lambda room: room.name)
def test_no_number_decides_outside_of_the_criteria(room: Room):
    files = [file for file in sorted(room.folder.rglob("*.py")) if file not in room.files]
    assert not [
        f"{file.relative_to(ROOT)}:{line}: {value}"
        for file in files
        for line, value in deciding(file.read_text(encoding="utf-8"))
    ]


@pytest.mark.parametrize(
    "source",
    [
        "LEAST = 0.1",
        'LEAST = 0.1\n"""Least share of a run."""',
        "def of(x):\n    return x > 1e-3",
        "def of(x, most=3):\n    return x[: most]",
        'def of(x):\n    """The size of x."""\n    return 3 * x ** 2.5',
    ],
)
def test_a_number_that_decides_is_seen(source):
    assert list(deciding(source))


@pytest.mark.parametrize(
    "source",
    [
        "x[3], x.transpose(0, 3, 1), np.empty((3, n)), 2 * x**3, 0.5 * x",
        'NORMAL = 1.4826\n"""The deviation over the median deviation, of normal noise (Hampel 1974)."""',
        'BLOCK = 4096\n"""Samples at a time. No answer depends on it."""',
        'def kernel(u):\n    """Parzen\'s kernel (Andrews 1991)."""\n    return 1 - 6 * u**2 + 6 * u**3',
    ],
)
def test_a_number_of_a_formula_or_of_a_size_is_free(source):
    assert not list(deciding(source))


def test_numbers_are_seen_in_the_criteria_themselves():
    for room in WITH_CRITERIA:
        assert [file for file in room.files if list(deciding(file.read_text(encoding="utf-8")))]

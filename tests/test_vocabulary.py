"""One word for one thing, the field's own: words that a textbook does not have stay out of the diagnosis."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FILES = sorted((ROOT / "ident" / "diagnosis").rglob("*.py"))
PUBLIC = {
    "alike", "beside", "elsewhere", "found", "instead_of", "left_out", "looked_at", "mended", "nats", "stated",
    "standing", "stood_in", "suspects", "terms_left_out",
}  # fmt: skip
"""Names of the contract: they are written into results, and stay."""
GONE = {
    "anew", "anywhere", "advice", "beginnings", "course", "doubtful", "foretell", "foretold", "glimpse",
    "heard", "hear", "jumping", "lateness", "learned", "likelier", "meanings", "memories", "mend", "outdone",
    "outlook", "outlooks", "paired", "polish", "promised", "rivals", "scattered", "shaken", "sight", "softness",
    "spoken", "stronger", "stepwise", "unforetold", "vain", "weighed",
}  # fmt: skip
"""Words that no name may be made of."""
NAMES = {"known": 56, "here": 22, "told": 6, "one": 133, "rest": 19, "left": 17, "kept": 10, "late": 6}
"""Words that say nothing as a name, and how many names are still made of them: fewer from time to time, never more."""
TEXTS = {
    "what": 33,
    "beside": 7,
    "tell": 8,
    "tells": 0,
    "told": 3,
    "alike": 6,
    "anew": 2,
    "doubted": 0,
    "leave": 0,
    "leaves": 0,
    "left": 19,
    "rest": 3,
}
"""How often each word still stands in a docstring: fewer from time to time, never more."""


def names(tree: ast.AST) -> Iterator[str]:
    """Every name that a file gives: functions, classes, arguments, variables, fields."""
    for node in ast.walk(tree):
        match node:
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name) | ast.arg(arg=name):
                yield name
            case ast.Name(id=name, ctx=ast.Store()):
                yield name
            case ast.Attribute(attr=name, ctx=ast.Store()):
                yield name


def words_of_names() -> Counter[str]:
    """How many names of the diagnosis are made of each word."""
    found: Counter[str] = Counter()
    for file in FILES:
        for name in names(ast.parse(file.read_text(encoding="utf-8"))):
            if name not in PUBLIC:
                found.update(set(re.findall(r"[a-z]+", re.sub(r"([A-Z])", r"_\1", name).lower())))
    return found


def words_of_docstrings() -> Counter[str]:
    """How often each word stands in docstrings of the diagnosis."""
    found: Counter[str] = Counter()
    for file in FILES:
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
                found.update(re.findall(r"[a-z]+", (ast.get_docstring(node) or "").lower()))
    return found


def test_no_name_is_made_of_a_word_that_was_given_up():
    """Files bear none of them either."""
    found = words_of_names()
    found.update(word for file in FILES for word in file.stem.split("_"))
    assert not {word: found[word] for word in GONE if found[word]}


def test_words_that_say_nothing_become_fewer():
    for counted, most in ((words_of_names(), NAMES), (words_of_docstrings(), TEXTS)):
        assert not {word: counted[word] for word, limit in most.items() if counted[word] > limit}

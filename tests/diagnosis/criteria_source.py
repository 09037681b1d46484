"""What is written in the source below each number of a diagnosis. It is read as text: no number is loaded for it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "ident" / "diagnosis"
FILES = [FOLDER / "criteria.py", FOLDER / "evidence" / "criteria.py", FOLDER / "discovery" / "criteria.py"]
FORM = re.compile(r"\[(?P<unit>[^]]+)\] (?P<meaning>[A-Z].+?)\. Why: (?P<reason>.+?)\. Test: (?P<test>\S+::\s?\S+)")


def documented() -> Iterator[tuple[str, str]]:
    """Each number of the criteria by name, and what is written below it."""
    for file in FILES:
        tree = ast.parse(file.read_text(encoding="utf-8"))
        sections = [node for node in tree.body if isinstance(node, ast.ClassDef) and node.name != "Criteria"]
        for owner, body in (("", tree.body), *((node.name, node.body) for node in sections)):
            for one, below in zip(body, [*body[1:], None], strict=True):
                if isinstance(one, ast.AnnAssign):
                    assert isinstance(below, ast.Expr)
                    yield f"{owner}.{ast.unparse(one.target)}", " ".join(str(ast.literal_eval(below.value)).split())


def named_tests() -> dict[str, str]:
    """The test that each number names, in tests/diagnosis."""
    read = {name: FORM.fullmatch(text) for name, text in documented()}
    assert not [name for name, found in read.items() if found is None]
    return {name: found["test"].replace(" ", "") for name, found in read.items() if found is not None}

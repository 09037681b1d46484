"""Move each number that decides by 30 % up and down, and see the test that it names fail.

python -m tests.moved_criteria [ROOM | SECTION | SECTION.NAME | FILE OF TESTS …]

Of a ratio near one, as of a cosine, its distance from one is moved. Where no test fails, either way, the number decides
nothing that a test sees: the table says so, and the run ends with 1. A number of one test is moved in a process of its
own, in which the source of the criteria is changed as it is loaded; nothing is written.
"""

from __future__ import annotations

import ast
import importlib.abc
import importlib.machinery
import importlib.util
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from tests.criteria_source import ROOMS, ROOT, Number, documented

MODULES = {".".join(file.relative_to(ROOT).with_suffix("").parts): file for room in ROOMS for file in room.files}
UP, DOWN = 1.3, 0.7
CAUGHT, PASSED, FAULT = 1, 0, 99  # what a process ends with


def moved(value: Any, factor: float) -> Any:
    """A number moved by a factor; an integer by one at least, of a ratio near one its distance from one."""
    if isinstance(value, int):
        nearest = round(value * factor)
        return nearest if nearest != value else value + (1 if factor > 1 else -1)
    return 1.0 + (value - 1.0) * factor if 0.9 <= value <= 1.5 and value != 1.0 else value * factor


class _Moved(ast.NodeTransformer):
    """The value of one field of one class with every number in it moved."""

    def __init__(self, owner: str, name: str, factor: float) -> None:
        self.owner, self.name, self.factor = owner, name, factor
        self.found = False

    def visit_Module(self, node: ast.Module) -> ast.Module:
        bodies = [node.body, *(one.body for one in node.body if isinstance(one, ast.ClassDef))]
        owners = ["", *(one.name for one in node.body if isinstance(one, ast.ClassDef))]
        for owner, body in zip(owners, bodies, strict=True):
            for one in body:
                if isinstance(one, ast.AnnAssign) and (owner, ast.unparse(one.target)) == (self.owner, self.name):
                    assert one.value is not None
                    self.found, one.value = True, self._scaled(one.value)
        return node

    def _scaled(self, value: ast.expr) -> ast.expr:
        for node in ast.walk(value):
            if isinstance(node, ast.Constant) and type(node.value) in (int, float):
                node.value = moved(node.value, self.factor)
        return value


class _Loader(importlib.machinery.SourceFileLoader):
    """Loads a module with one number moved."""

    change: _Moved

    def get_code(self, _fullname: str) -> Any:
        source = self.change.visit(ast.parse(Path(self.path).read_bytes()))
        return compile(source, self.path, "exec", dont_inherit=True)


class _Finder(importlib.abc.MetaPathFinder):
    def __init__(self, change: _Moved) -> None:
        self.change = change

    def find_spec(self, name: str, _path: Sequence[str] | None, _target: ModuleType | None = None) -> Any:
        if name not in MODULES:
            return None
        loader = _Loader(name, str(MODULES[name]))
        loader.change = self.change
        return importlib.util.spec_from_file_location(name, MODULES[name], loader=loader)


def ended(number: Number, factor: float) -> int:
    """What pytest ends with on one test with a number moved, in a process of its own."""
    child = os.fork()
    if child:
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    with Path(os.devnull).open("w") as silent:
        os.dup2(silent.fileno(), 1)
        os.dup2(silent.fileno(), 2)
    change = _Moved(number.section, number.name, factor)
    sys.meta_path.insert(0, _Finder(change))
    code = int(pytest.main(["-x", "-q", "-p", "no:cacheprovider", "--full", str(ROOT / number.test)]))
    os._exit(code if change.found else FAULT)


def outcome(number: Number) -> str:
    """The ways in which a moved number makes its test fail: "up and down", "up", "down" or "neither"."""
    codes = {way: ended(number, factor) for way, factor in (("up", UP), ("down", DOWN))}
    if faults := {way: code for way, code in codes.items() if code not in (CAUGHT, PASSED)}:
        return f"fault: {faults}"
    return " and ".join(way for way, code in codes.items() if code == CAUGHT) or "neither"


def main(asked: Sequence[str]) -> int:
    """The table of all numbers, or of those that are asked for; 1 where one moves no test."""
    os.environ["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"
    lost = 0
    for room in ROOMS:
        for module in room.below:  # loaded once for all processes
            importlib.import_module(module)
        assert not {name for name, file in MODULES.items() if file in room.files} & sys.modules.keys()
        for number in (one for one in documented() if one.room == room):
            asked_by = {room.name, number.section, number.full_name, number.test.partition("::")[0].rpartition("/")[2]}
            if not asked or asked_by & {*asked}:
                found = outcome(number)
                lost += found not in ("up and down", "up", "down")
                print(f"{number.full_name:44} {found:12} {number.test}", flush=True)
    return 1 if lost else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

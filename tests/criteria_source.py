"""What is written in the source below each number that decides. It is read as text: no number is loaded for it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FORM = re.compile(r"\[(?P<unit>[^]]+)\] (?P<meaning>[A-Z].+?)\. Why: (?P<reason>.+?)\. Test: (?P<test>\S+::\s?\S+)")


@dataclass(frozen=True)
class Room:
    """A room of the library whose numbers stand in the `files`, and the modules `below` it, which know none of them."""

    name: str
    files: tuple[Path, ...]
    below: tuple[str, ...]

    @property
    def folder(self) -> Path:
        """Where its code is."""
        return ROOT / "ident" / self.name

    def test(self, written: str) -> str:
        """The path of a test from the root; a number of a room names one in the room's own folder of tests."""
        found = written.replace(" ", "")
        return found if found.startswith("tests/") else f"tests/{self.name}/{found}"


def _room(name: str, *below: str) -> Room:
    return Room(name, tuple(sorted((ROOT / "ident" / name).rglob("criteria*.py"))), below)


ROOMS = (
    Room("rounding", (ROOT / "ident/rounding.py",), ("scipy.stats", "scipy.optimize", "scipy.signal")),
    _room("noise", "ident.run"),
    _room("fit", "ident.noise.floor", "ident.checks.check", "ident.custom.definition", "ident.simulation.simulate"),
    _room("diagnosis", "ident.fit.identification", "ident.design.proposal", "ident.residuals.views"),
    _room("bench", "ident.diagnosis.diagnose"),
)
"""In the order in which they import each other."""


@dataclass(frozen=True)
class Number:
    """A number of a room: the section that it stands in ("" for none), its name, and what is written below it."""

    room: Room
    file: Path
    section: str
    name: str
    text: str

    @property
    def full_name(self) -> str:
        """Unique among all rooms."""
        return f"{self.section}.{self.name}"

    @property
    def test(self) -> str:
        """The test that it names, from the root."""
        found = FORM.fullmatch(self.text)
        assert found is not None, f"{self.file}: {self.full_name}: {self.text}"
        return self.room.test(found["test"])


def documented() -> Iterator[Number]:
    """Each number of the criteria of all rooms."""
    return (number for room in ROOMS for file in room.files for number in numbers_of(room, file))


def numbers_of(room: Room, file: Path) -> Iterator[Number]:
    """Each number of one file."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    sections = [node for node in tree.body if isinstance(node, ast.ClassDef) and node.name != "Criteria"]
    for owner, body in (("", tree.body), *((node.name, node.body) for node in sections)):
        for one, below in zip(body, [*body[1:], None], strict=True):
            if isinstance(one, ast.AnnAssign):
                assert isinstance(below, ast.Expr)
                text = " ".join(str(ast.literal_eval(below.value)).split())
                yield Number(room, file, owner, ast.unparse(one.target), text)

"""The changes that CONTRIBUTING.md works out, read from its text: new files, and lines beside or instead of others."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
_BLOCK = re.compile(
    r"^`([\w/.]+)`, (a new file|before|behind|instead of)(?: `([^\n]+)`)?:\n\n((?:    [^\n]*\n|\n(?=\n|    ))+)", re.M
)
_DEFINITION = ("def ", "class ", "@")


@dataclass(frozen=True)
class Change:
    """A new file, or lines before, behind or instead of the only line of a file that begins with `line`."""

    file: str
    how: str
    line: str
    text: str

    def put_into(self, copy: Path) -> None:
        """Change the file in a copy of the program."""
        file = copy / self.file
        if self.how == "a new file":
            file.parent.mkdir(exist_ok=True)
            with file.open("x", encoding="utf-8") as new:
                new.write(self.text)
            return
        lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
        (place,) = self.places(lines)
        begin, end = place + (self.how == "behind"), place + (self.how != "before")
        file.write_text("".join([*lines[:begin], self.text, *lines[end:]]), encoding="utf-8")

    def places(self, lines: list[str]) -> list[int]:
        """The numbers of the lines that begin as quoted."""
        return [number for number, line in enumerate(lines) if line.startswith(self.line)]


def worked_examples() -> dict[str, tuple[Change, ...]]:
    """The changes of each example, by its heading."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    done = text.partition("## Five common changes, done\n")[2].partition("\n## ")[0]
    sections = (part.partition("\n") for part in done.split("\n### ")[1:])
    return {
        heading: tuple(Change(file, how, line, _text(how, block)) for file, how, line, block in _BLOCK.findall(body))
        for heading, _, body in sections
    }


def _text(how: str, block: str) -> str:
    """The text of an indented block; two empty lines part a definition from what follows it."""
    text = re.sub(r"^    ", "", block, flags=re.M)
    return text + "\n\n" if how == "before" and text.startswith(_DEFINITION) else text

"""The tutorial, run as it stands: ``python -m docs.tutorial FOLDER`` draws its pictures from the record in FOLDER.

A test runs the same blocks and compares what they print with what the page says.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import shutil
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

HERE = Path(__file__).resolve().parent
PAGE = HERE / "tutorial.md"
LONG = "<!-- long -->"
_BLOCK = re.compile(r"(?P<long><!-- long -->\n\n)?```(?P<kind>\w+)\n(?P<text>.*?)```", re.S)


@dataclass(frozen=True)
class Block:
    """A block of the page: python, sh, yaml, or text, what the one before it prints; `long` takes minutes."""

    kind: str
    text: str
    long: bool


def parts() -> tuple[list[Block], list[Block]]:
    """The blocks about the measured machine, and those about the simulated one."""
    measured, _, simulated = PAGE.read_text(encoding="utf-8").partition("## A simulated machine")
    return list(blocks(measured)), list(blocks(simulated))


def blocks(text: str) -> Iterator[Block]:
    """The blocks of a text, in order."""
    for found in _BLOCK.finditer(text):
        yield Block(found["kind"], found["text"], found["long"] is not None)


def record(folder: Path, logs: Path) -> None:
    """The folder `mts` of the tutorial, from the logs of the record, described as the page says."""
    (folder / "mts").mkdir()
    shutil.copytree(logs, folder / "mts" / "runs", copy_function=shutil.copyfile)
    (description,) = (block.text for block in parts()[0] if block.kind == "yaml")
    (folder / "mts" / "matrix.yaml").write_text(description, encoding="utf-8")


def printed(block: Block, names: dict[str, Any]) -> str:
    """What a block of Python prints; `names` are those that the blocks before it have made."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        exec(compile(block.text, PAGE.name, "exec"), names)
    return out.getvalue()


def main(logs: Path) -> None:
    """Draw the pictures of the page, light and dark."""
    from docs.pictures.remake import draw  # noqa: PLC0415  the tests need none of it

    with TemporaryDirectory() as folder:
        record(Path(folder), logs)
        os.chdir(folder)
        names: dict[str, Any] = {}
        for block in parts()[0]:
            if block.kind == "python" and not block.long:
                print(printed(block, names))
        os.chdir(HERE)
    draw("tutorial-bode", names["fit"], "bode")
    draw("tutorial-residual-correlation", names["fit"], "residual-correlation", run="off")


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())

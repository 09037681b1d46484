"""Fit and diagnose measured machines as a new user would:  python -m tests.measured [FOLDER …]  prints the table.

Without folders those beside the checkout. `--page` writes docs/measured.md as well.
"""

from __future__ import annotations

import sys
from pathlib import Path

from tests.measured.judged import KNOWN, judged

ROOT = Path(__file__).resolve().parents[2]
HEADER = (
    "machine",
    "model",
    "linear, fitted / held back",
    "with what helps",
    "named",
    "standing",
    "proposed beyond",
    "s",
)


def line(cells: tuple[str, ...]) -> str:
    """A row of a table."""
    return f"| {' | '.join(cells)} |"


def main(arguments: list[str]) -> None:
    """Print a row a machine, as soon as it is there."""
    folders = [Path(name) for name in arguments if name != "--page"]
    folders = folders or [ROOT.parent / "shared" / "data" / name for name in KNOWN]
    lines = [line(HEADER), line(("---",) * len(HEADER))]
    print(*lines, sep="\n", flush=True)
    texts = []
    for folder in folders:
        found = judged(folder)
        lines.append(line(found.row))
        texts.append(f"**{found.name}.** Known: {KNOWN.get(found.name, 'nothing')}. Said: {found.found.verdict.text}")
        print(lines[-1], flush=True)
    if "--page" in arguments:
        page = ROOT / "docs" / "measured.md"
        before, mark, _ = page.read_text(encoding="utf-8").partition("<!-- table -->\n")
        page.write_text("\n".join([before + mark, *lines, "", "\n\n".join(texts), ""]), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])

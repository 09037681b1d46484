"""Fit and diagnose measured machines as a new user would:  python -m tests.measured [FOLDER …]  prints the table.

Without folders those beside the checkout. `--page` writes the rows of these machines into docs/measured.md as well.
"""

from __future__ import annotations

import sys
from pathlib import Path

from tests.measured.judged import KNOWN, judged
from tests.measured.page import line, renewed

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
    "RMSE held back",
    "by hand",
    "published",
    "run",
)


def main(arguments: list[str]) -> None:
    """Print a row a machine, as soon as it is there."""
    folders = [Path(name) for name in arguments if name != "--page"]
    folders = folders or [ROOT.parent / "shared" / "data" / name for name in KNOWN]
    print(line(HEADER), line(("---",) * len(HEADER)), sep="\n", flush=True)
    page = ROOT / "docs" / "measured.md"
    for folder in folders:
        found = judged(folder)
        row, known = line(found.row), KNOWN.get(found.name, "nothing")
        print(row, flush=True)
        if "--page" in arguments:
            text = f"**{found.name}.** Known: {known}. Said: {found.found.verdict.text}"
            made = renewed(page.read_text(encoding="utf-8"), HEADER, {found.name: row}, {found.name: text})
            page.write_text(made, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])

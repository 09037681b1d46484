"""`python -m tests.papers [ROW …]`: works out the rows of the three papers and writes docs/papers.md, all or these."""

from __future__ import annotations

import sys
import time
from pathlib import Path

from tests.papers.page import cells, line, page, renewed
from tests.papers.row import Answer, answered
from tests.papers.rows import ROWS

PAGE = Path(__file__).resolve().parents[2] / "docs" / "papers.md"


def main(names: list[str]) -> int:
    """Print each row as soon as it is there; 1 where a figure misses its bar."""
    chosen = [row for row in ROWS if not names or row.name in names]
    answers: list[Answer] = []
    for row in chosen:
        begun = time.monotonic()
        answers.append(answered(row))
        print(line(cells(answers[-1])), f"{time.monotonic() - begun:.1f} s", flush=True)
    text = renewed(PAGE.read_text(encoding="utf-8"), answers) if names else page(answers)
    PAGE.write_text(text, encoding="utf-8")
    return int(not all(one.holds for one in answers))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

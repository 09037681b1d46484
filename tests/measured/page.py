"""The page of measured machines: a row and a paragraph each, of which those that are not run anew stay."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

MARK = "<!-- table -->\n"
"""Where the table begins; what stands before is written by hand."""


def line(cells: Sequence[str]) -> str:
    """A row of a table."""
    return f"| {' | '.join(cells)} |"


def renewed(page: str, header: Sequence[str], rows: Mapping[str, str], texts: Mapping[str, str]) -> str:
    """The page with the rows and paragraphs of these machines, by name; those of others stay, in their order."""
    before, mark, after = page.partition(MARK)
    kept = {row.split(" | ")[0].removeprefix("| "): row for row in after.splitlines() if row.startswith("| ")}
    told = {text[2:].partition(".**")[0]: text for text in after.splitlines() if text.startswith("**")}
    names = [*(name for name in kept if name in told), *(name for name in rows if name not in told)]
    table = [line(header), line(["---"] * len(header)), *((kept | rows)[name] for name in names)]
    paragraphs = "\n\n".join((told | texts)[name] for name in names)
    return "\n".join([before + mark, *table, "", paragraphs, ""])

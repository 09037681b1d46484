"""Results as tables that a notebook shows by itself: plain HTML, whose colours are those of the notebook's theme."""

from __future__ import annotations

from collections.abc import Container, Iterable, Sequence
from dataclasses import dataclass
from html import escape


@dataclass(frozen=True)
class Listing:
    """A table of text: its title, the titles of its columns, its rows; the columns in `numbers` stand to the right."""

    title: str
    header: Sequence[str]
    rows: Iterable[Sequence[str]]
    numbers: Container[str] = ()

    def html(self) -> str:
        """As HTML, every text escaped."""
        sides = ["right" if title in self.numbers else "left" for title in self.header]
        head = _row("th", self.header, sides)
        body = "".join(_row("td", row, sides) for row in self.rows)
        caption = f'<caption style="text-align: left"><b>{escape(self.title)}</b></caption>' if self.title else ""
        return f"<table>{caption}<thead>{head}</thead><tbody>{body}</tbody></table>"


def _row(tag: str, cells: Sequence[str], sides: Sequence[str]) -> str:
    inner = (
        f'<{tag} style="text-align: {side}">{escape(cell)}</{tag}>' for cell, side in zip(cells, sides, strict=True)
    )
    return f"<tr>{''.join(inner)}</tr>"


def html(listings: Iterable[Listing | str]) -> str:
    """Tables and lines of text, one below the other."""
    return "".join(f"<p>{escape(one)}</p>" if isinstance(one, str) else one.html() for one in listings)


class Shown:
    """A result that shows itself in a notebook."""

    def listings(self) -> Iterable[Listing | str]:
        """Its tables and sentences, in the order in which they are read."""
        raise NotImplementedError

    def _repr_html_(self) -> str:
        return html(self.listings())

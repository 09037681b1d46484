"""Results as tables: one builder, :meth:`TabularResult.listings`, serves notebooks, ``print`` and the prompt.

A result is data. Where its tables take a file of their own, that file registers them for its type (:func:`listings`):
the result knows nothing of how it is shown.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Sequence
from dataclasses import dataclass
from functools import singledispatch
from html import escape
from importlib import import_module
from typing import Any

MOST_ROWS = 60
"""Rows of a table that plain text shows whole; of a longer one the first and the last half of them.

A screen or two: `print` is a look at a result. A notebook, whose tables scroll, shows every row.
"""
_GAP = "  "


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

    def text(self) -> str:
        """As plain text, the columns aligned; of more than :data:`MOST_ROWS` rows those in the middle are counted."""
        rows = [tuple(row) for row in self.rows]
        half = MOST_ROWS // 2
        left_out = len(rows) - 2 * half if len(rows) > MOST_ROWS else 0
        shown = [tuple(self.header), *(rows[:half] + rows[-half:] if left_out else rows)]
        widths = [max(map(len, column)) for column in zip(*shown, strict=True)]
        right = [title in self.numbers for title in self.header]
        lines = [
            _GAP.join(
                cell.rjust(width) if to_right else cell.ljust(width)
                for cell, width, to_right in zip(row, widths, right, strict=True)
            ).rstrip()
            for row in shown
        ]
        if left_out:
            lines.insert(1 + half, f"… {left_out} more rows …")
        return "\n".join(([self.title] if self.title else []) + lines)


def _row(tag: str, cells: Sequence[str], sides: Sequence[str]) -> str:
    inner = (
        f'<{tag} style="text-align: {side}">{escape(cell)}</{tag}>' for cell, side in zip(cells, sides, strict=True)
    )
    return f"<tr>{''.join(inner)}</tr>"


def html(tables: Iterable[Listing | str]) -> str:
    """Tables and lines of text, one below the other."""
    return "".join(f"<p>{escape(one)}</p>" if isinstance(one, str) else one.html() for one in tables)


def text(tables: Iterable[Listing | str]) -> str:
    """The same as plain text: an empty line around each table."""
    parts: list[str] = []
    after_table = False
    for one in tables:
        table = not isinstance(one, str)
        if parts and (table or after_table):
            parts.append("")
        parts.append(one if isinstance(one, str) else one.text())
        after_table = table
    return "\n".join(parts)


TABLES: dict[str, str] = {}
"""The module that has the tables of the results of a module. `ident` says it, which knows every room; it is imported
when such a result is shown for the first time."""


@singledispatch
def listings(result: Any) -> Iterable[Listing | str]:
    """The tables and sentences of a result, in the order in which they are read."""
    found: Iterable[Listing | str] = _registered(listings, result)(result)
    return found


@singledispatch
def in_brief(result: Any) -> tuple[str, ...]:
    """A result in a few lines."""
    found: tuple[str, ...] = _registered(in_brief, result)(result)
    return found


def _registered(function: Any, result: Any) -> Any:
    """What is registered for the type of a result. Raises NotImplementedError."""
    for base in type(result).__mro__:
        if base.__module__ in TABLES:
            import_module(TABLES[base.__module__])
    found = function.dispatch(type(result))
    if found is function.dispatch(object):
        raise NotImplementedError(f"no tables are registered for {type(result).__name__}")
    return found


class TabularResult:
    """A result that shows itself: as HTML in a notebook, as the same tables in plain text to `print` and the prompt."""

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        # Before @dataclass sees the class: where a class has no __repr__ it writes one that holds every array.
        cls.__repr__ = TabularResult.__repr__  # type: ignore[method-assign]

    def listings(self) -> Iterable[Listing | str]:
        """Its tables and sentences, in the order in which they are read."""
        return listings(self)

    def _repr_html_(self) -> str:
        return html(self.listings())

    def __str__(self) -> str:
        return text(self.listings())

    def __repr__(self) -> str:
        return text(self.listings())

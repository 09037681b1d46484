"""What a report is made of: the same pieces become HTML and PDF."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

from markupsafe import Markup

from app.report.sheet import Logo
from ident.figures.render import Chart


@dataclass(frozen=True)
class Formula:
    """A cell that is mathematics where the form can show it, and text elsewhere."""

    mathml: Markup
    text: str

    def __html__(self) -> str:
        """What a template puts into a page."""
        return self.mathml

    def __str__(self) -> str:
        return self.text


Cell = str | Formula


@dataclass(frozen=True)
class Heading:
    """A chapter (level 2) or a part of one (level 3)."""

    text: str
    level: Literal[2, 3] = 2
    kind: str = field(default="heading", init=False)


@dataclass(frozen=True)
class Text:
    """A paragraph; `tone` is "", "faint" or "verdict"."""

    text: str
    tone: str = ""
    kind: str = field(default="text", init=False)


@dataclass(frozen=True)
class Table:
    """Rows under a header; columns in `numbers` are set to the right, a severity in `marked` is set off."""

    header: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    numbers: tuple[int, ...] = ()
    marked: int | None = None
    kind: str = field(default="table", init=False)


@dataclass(frozen=True)
class Tables:
    """Small tables side by side."""

    tables: tuple[Table, ...]
    kind: str = field(default="tables", init=False)


@dataclass(frozen=True)
class Figure:
    """A chart with its caption, or what prevented it."""

    name: str
    chart: Chart | str
    caption: str
    kind: str = field(default="figure", init=False)


@dataclass(frozen=True)
class Facts:
    """Names and what they stand for; in two columns where they are not `wide`."""

    pairs: tuple[tuple[str, str], ...]
    wide: bool = True
    kind: str = field(default="facts", init=False)


@dataclass(frozen=True)
class Signatures:
    """Lines to be signed: for what, and who is known to have done it, with the date."""

    lines: tuple[tuple[str, str, str], ...]
    kind: str = field(default="signatures", init=False)


Block = Heading | Text | Table | Tables | Figure | Facts | Signatures


@dataclass(frozen=True)
class Report:
    """Title, a line below it, and the pieces in their order."""

    title: str
    lead: str
    blocks: Sequence[Block]
    logo: Logo | None = None

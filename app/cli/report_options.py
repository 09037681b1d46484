"""Options of what a data sheet states."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

_PANEL = "Data sheet"
Laboratory = Annotated[
    str, typer.Option(metavar="NAME", help="Name of the laboratory on reports.", rich_help_panel=_PANEL)
]
Logo = Annotated[
    Path | None, typer.Option(metavar="FILE", help="PNG or JPEG at the head of reports.", rich_help_panel=_PANEL)
]
Customer = Annotated[str, typer.Option(metavar="NAME", help="Customer.", rich_help_panel=_PANEL)]
Order = Annotated[str, typer.Option(metavar="TEXT", help="Order number.", rich_help_panel=_PANEL)]
Operator = Annotated[str, typer.Option(metavar="NAME", help="Who made the test.", rich_help_panel=_PANEL)]
TestDate = Annotated[
    str, typer.Option("--date", metavar="DATE", help="Date of the test: 2026-03-31.", rich_help_panel=_PANEL)
]
OilTemperature = Annotated[
    str, typer.Option(metavar="QUANTITY", help="Oil temperature: 42 degC.", rich_help_panel=_PANEL)
]


def checked(logo: Path | None) -> Path | None:
    """The same file, read once so that what is no picture is refused at once. Raises Unusable."""
    if logo is not None:
        from app.report.sheet import logo as read

        read(logo)
    return logo

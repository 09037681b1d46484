"""Where the service keeps its data, for the commands that run it or read what it stored."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from app.settings import Settings

Data = Annotated[
    Path | None,
    typer.Option(metavar="DIR", envvar="SERVOIDENT_DATA", help="Data folder (SERVOIDENT_DATA)."),
]
Database = Annotated[
    str,
    typer.Option(metavar="URL", envvar="SERVOIDENT_DATABASE", help="PostgreSQL instead of SQLite in the data folder."),
]


def settings(data: Path | None, database: str, **others: Any) -> Settings:
    """The service's settings with what the command line gives."""
    from app.settings import Settings

    given: dict[str, Any] = {} if data is None else {"data": data}
    return Settings(**given, database_url=database, **others)

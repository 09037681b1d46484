"""Where the service keeps its data, for the commands that run it or read what it stored."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ident.errors import Unusable
from ident.words.nearest import did_you_mean

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
Blobs = Annotated[
    str,
    typer.Option(
        metavar="PLACE",
        envvar="SERVOIDENT_BLOBS",
        help="Storage of raw uploads: s3://BUCKET/PREFIX or a shared folder (SERVOIDENT_BLOBS).",
        show_envvar=False,
    ),
]
Log = Annotated[
    str,
    typer.Option(
        metavar="text|json", envvar="SERVOIDENT_LOG", help="Format of the log on standard error.", show_envvar=False
    ),
]


def settings(data: Path | None, database: str, **others: Any) -> Settings:
    """The service's settings with what the command line gives."""
    from app.settings import Settings

    if others.get("log", "text") not in ("text", "json"):
        raise Unusable(
            "bad-option",
            f"{others['log']!r} is not a form of a log",
            "--log",
            did_you_mean(others["log"], ("text", "json")),
        )
    given: dict[str, Any] = {} if data is None else {"data": data}
    return Settings(**given, database_url=database, **others)

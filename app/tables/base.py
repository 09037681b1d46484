"""What all tables share: their base, and how times are written.

Times are UTC in ISO 8601 text, so that SQLite and PostgreSQL sort and return them alike.
"""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import Any

from sqlalchemy import JSON
from sqlalchemy.orm import DeclarativeBase


def now() -> str:
    """This moment, UTC."""
    return datetime.now(UTC).isoformat(timespec="microseconds")


def before(age: timedelta) -> str:
    """The moment so long ago, UTC."""
    return (datetime.now(UTC) - age).isoformat(timespec="microseconds")


class Base(DeclarativeBase):
    """Common base; its metadata is what the migrations are checked against."""

    type_annotation_map = {dict[str, Any]: JSON, list[Any]: JSON}  # noqa: RUF012  SQLAlchemy's own convention

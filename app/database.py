"""The database: engine, sessions, migrations."""

from __future__ import annotations

import sqlite3
from pathlib import Path
from typing import Any

from alembic import command
from alembic.config import Config
from alembic.util import CommandError
from sqlalchemy import Engine, create_engine, event, make_url, text
from sqlalchemy.exc import ArgumentError, DatabaseError
from sqlalchemy.orm import Session, sessionmaker

from ident.errors import Unusable

MIGRATIONS = Path(__file__).resolve().parent.parent / "migrations"


def connect(url: str) -> Engine:
    """An engine; SQLite in write-ahead mode, with foreign keys, waiting for locks instead of failing.

    Raises Unusable for the URL of anything but SQLite and PostgreSQL.
    """
    driver = url.replace("postgresql://", "postgresql+psycopg://", 1)
    try:
        if not driver.startswith(("sqlite:///", "postgresql+psycopg://")):
            raise ValueError
        engine = create_engine(driver, pool_pre_ping=not driver.startswith("sqlite"))
    except (ArgumentError, ValueError):
        raise Unusable(
            "bad-database", "not the URL of a PostgreSQL database", "--database", "write postgresql://USER@HOST/NAME"
        ) from None
    if driver.startswith("sqlite"):

        @event.listens_for(engine, "connect")
        def configure(connection: sqlite3.Connection, _: Any) -> None:
            for pragma in ("journal_mode=WAL", "foreign_keys=ON", "busy_timeout=10000", "synchronous=FULL"):
                connection.execute(f"PRAGMA {pragma}")

    return engine


def sessions(engine: Engine) -> sessionmaker[Session]:
    """Sessions whose objects stay readable after the commit."""
    return sessionmaker(engine, expire_on_commit=False)


def migrate(url: str) -> None:
    """Bring the database to the newest schema. Raises Unusable where it cannot be reached or written."""
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS))
    config.attributes["url"] = url
    try:
        command.upgrade(config, "head")
    except CommandError:
        raise Unusable(
            "newer-database", "a later version of the program made it", shown(url), "run that version or a later one"
        ) from None
    except DatabaseError as error:
        what = str(error.orig).partition("\n")[0]
        raise Unusable("no-database", what, shown(url), "check its address, its rights and the free space") from error


def shown(url: str) -> str:
    """The URL of a database without its password."""
    return make_url(url).render_as_string(hide_password=True)


def reachable(engine: Engine) -> bool:
    """True when the database answers and has been migrated."""
    try:
        with engine.connect() as connection:
            return bool(connection.execute(text("SELECT count(*) FROM alembic_version")).scalar())
    except Exception:  # any failure means the same to the one who asks
        return False

"""The database: engine, sessions, migrations."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from alembic.util import CommandError
from sqlalchemy import Engine, create_engine, event, make_url, text
from sqlalchemy.exc import ArgumentError, DatabaseError
from sqlalchemy.orm import Session, sessionmaker

from ident.errors import Unusable

MIGRATIONS = Path(__file__).resolve().parent.parent / "migrations"
HEEDFUL = {
    "connect_timeout": 5,
    "keepalives_idle": 5,
    "keepalives_interval": 2,
    "keepalives_count": 3,
    "tcp_user_timeout": 10_000,
}
"""Of connections to PostgreSQL: a cut line is noticed within seconds (s, the last ms), not after the system's hours."""

APART = {"apart": True}
"""Of a session: what it commits is not the change that was asked for, and carries no line of the audit."""

Acts = Callable[[Session], None]


def connect(url: str) -> Engine:
    """An engine; SQLite in write-ahead mode, with foreign keys, waiting for locks instead of failing.

    Raises Unusable for the URL of anything but SQLite and PostgreSQL.
    """
    driver = url.replace("postgresql://", "postgresql+psycopg://", 1)
    try:
        if not driver.startswith(("sqlite:///", "postgresql+psycopg://")):
            raise ValueError
        others: dict[str, Any] = {"pool_pre_ping": True, "connect_args": HEEDFUL}
        engine = create_engine(driver, **({} if driver.startswith("sqlite") else others))
    except (ArgumentError, ValueError):
        raise Unusable(
            "bad-database", "not the URL of a PostgreSQL database", "--database", "write postgresql://USER@HOST/NAME"
        ) from None
    if driver.startswith("sqlite"):

        @event.listens_for(engine, "connect")
        def configure(connection: sqlite3.Connection, _: Any) -> None:
            for pragma in ("journal_mode=WAL", "foreign_keys=ON", "busy_timeout=10000", "synchronous=FULL"):
                connection.execute(f"PRAGMA {pragma}")

    else:

        @event.listens_for(engine, "connect")
        def without_delay(connection: Any, _: Any) -> None:
            # What is asked here is answered sooner than helpers are started, or the query is compiled.
            for setting in ("max_parallel_workers_per_gather = 0", "jit = off"):
                connection.execute(f"SET {setting}")
            connection.commit()

    return engine


def sessions(engine: Engine) -> sessionmaker[Session]:
    """Sessions whose objects stay readable after the commit."""
    return sessionmaker(engine, expire_on_commit=False)


def on_commit(made: sessionmaker[Session], before: Acts, after: Acts) -> None:
    """Have each session of these act before its commit, within the transaction, and after it."""
    event.listen(made, "before_commit", before)
    event.listen(made, "after_commit", after)


def migrate(url: str, revision: str = "head") -> None:
    """Bring the database to a schema, the newest. Raises Unusable where it cannot be reached or written."""
    with _answering(url):
        command.upgrade(_alembic(url), revision)


def steps(url: str) -> list[str]:
    """What `migrate` would do, a line each. Raises Unusable where the database is newer, or cannot be reached."""
    config = _alembic(url)
    scripts = ScriptDirectory.from_config(config)
    engine = connect(url)
    with _answering(url), engine.connect() as connection:
        stands = MigrationContext.configure(connection).get_current_revision()
        ahead = list(scripts.iterate_revisions("head", stands or "base"))
    engine.dispose()
    return [f"{step.revision}: {step.doc.rstrip('.')}" for step in reversed(ahead) if step.revision != stands]


def _alembic(url: str) -> Config:
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS))
    config.attributes["url"] = url
    return config


@contextmanager
def _answering(url: str) -> Iterator[None]:
    """Raise Unusable where the database is of a later version, or does not answer."""
    try:
        yield
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

"""The service's records at hand, for commands that need no service to answer."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.data_options import settings
from ident.errors import Unusable

if TYPE_CHECKING:
    from sqlalchemy.orm import Session, sessionmaker


@contextmanager
def records(data: Path | None, database: str) -> Iterator[sessionmaker[Session]]:
    """The database, brought up to date. Raises Unusable where it cannot be reached, or refuses what is asked."""
    from app.database import connect, migrate, sessions
    from app.errors import Failure

    chosen = settings(data, database)
    chosen.make_folders()
    migrate(chosen.database)
    engine = connect(chosen.database)
    try:
        yield sessions(engine)
    except Failure as error:
        raise Unusable(error.code, error.what, error.where, error.remedy) from None
    finally:
        engine.dispose()

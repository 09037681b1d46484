"""What must hold before a database is brought to another schema."""

from __future__ import annotations

import shutil
import time

from app.database import connect, migrate, sessions, shown, steps
from app.operation import repository
from app.settings import Settings
from app.workers.pulse import BEAT
from ident.errors import Unusable

__all__ = ["check_safe", "migrate", "steps"]


def check_safe(settings: Settings) -> None:
    """Raise Unusable where a schema cannot be changed safely.

    A table of SQLite is changed by making it anew, so that for a moment there are two.
    """
    file = settings.data / "servoident.sqlite"
    if not settings.database_url and file.exists():
        size, free = file.stat().st_size, shutil.disk_usage(settings.data).free
        if free < 2 * size:
            what = f"{free >> 20} MB are free, and the database of {size >> 20} MB is copied on the way"
            raise Unusable("no-room", what, str(file), "free some space first")
    before = _beats(settings)
    time.sleep(1.5 * BEAT if before else 0.0)
    after = _beats(settings)
    at_work = [name for name, beat in after.items() if before.get(name) != beat]
    if at_work:
        what = f"{', '.join(at_work)} works on it at this moment"
        raise Unusable("in-use", what, shown(settings.database), "stop the service and its workers first")


def _beats(settings: Settings) -> dict[str, int]:
    """The beat of each worker; none in a database of a version that knew no workers."""
    engine = connect(settings.database)
    with sessions(engine)() as session:
        found = repository.beats(session)
    engine.dispose()
    return found

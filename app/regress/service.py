"""The approved actuators of a data folder, rechecked one after the other."""

from __future__ import annotations

from collections.abc import Iterator

from app.blobs import open_storage
from app.database import connect, reachable, sessions, shown
from app.matrices.stored import load_row
from app.regress.recheck import Recheck, recheck
from app.regress.repository import Asked, approved
from app.settings import Settings
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.progress import Report


def regress(settings: Settings, asked: Asked, tolerance: float, report: Report) -> Iterator[Recheck]:
    """Recheck the set in force of each actuator that is asked for, by serial number.

    A change of more than `tolerance` (relative) and of more than a tenth of the standard error counts as moved.
    Raises Unusable where the data folder holds no database.
    """
    if settings.database_url == "" and not (settings.data / "servoident.sqlite").is_file():
        raise Unusable("no-database", "no service has stored anything there", str(settings.data), "name it with --data")
    engine = connect(settings.database)
    if not reachable(engine):
        remedy = "check its address, and bring it up to date with `servoident migrate`"
        raise Unusable(
            "no-database", "the database does not answer or is not up to date", shown(settings.database), remedy
        )
    with sessions(engine)() as session:
        sets = approved(session, asked)
    storage = open_storage(settings)
    for fit, row in sets:
        try:
            matrix = load_row(storage, row)
        except (Unusable, OSError) as error:
            yield Recheck(fit.serial, fit.id, (), tolerance, 0.0, f"its matrix cannot be read: {error}")
            continue
        yield recheck(fit.serial, fit.id, FitResult.from_json(fit.result), matrix, tolerance, report)
    engine.dispose()

"""`servoident migrate`: bring the database up to date."""

from __future__ import annotations

from app.cli.data_options import Data, Database, settings


def migrate(data: Data = None, database: Database = "") -> None:
    """Bring the database to this version's schema. The service does it too when it starts."""
    from app.database import migrate as migrated

    chosen = settings(data, database)
    chosen.make_folders()
    migrated(chosen.database)
    print("the database is up to date")

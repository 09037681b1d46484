"""`servoident migrate`: bring the database up to date."""

from __future__ import annotations

from typing import Annotated

import typer

from app.cli.data_options import Data, Database, settings


def migrate(
    data: Data = None,
    database: Database = "",
    plan: Annotated[bool, typer.Option("--plan", help="Only say what would be done.")] = False,
) -> None:
    """Bring the database to this version's schema, saying each step. The service does it too when it starts.

    It refuses where a later version made the database, where the disk has no room for a copy of it, and where a
    process of the service is at work on it.
    """
    from app.operation.migration import check_safe, steps
    from app.operation.migration import migrate as migrated

    chosen = settings(data, database)
    chosen.make_folders()
    ahead = steps(chosen.database)
    for step in ahead:
        print(step)
    if plan:
        print(f"{len(ahead)} steps would be done" if ahead else "nothing is to be done")
        return
    if ahead:
        check_safe(chosen)
    migrated(chosen.database)
    print("the database is up to date")

"""`servoident migrate`: bring the database up to date."""

from __future__ import annotations

from typing import Annotated

import typer

from app.cli.data_options import Data, Database, settings


def migrate(
    data: Data = None,
    database: Database = "",
    plan: Annotated[bool, typer.Option("--plan", help="Only print the steps.")] = False,
) -> None:
    """Upgrade the database to the schema of this version.

    It prints each step. The service does the same when it starts. It stops if a later version made the database, if the
    disk has no room for a copy, or if a process of the service uses the database.
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

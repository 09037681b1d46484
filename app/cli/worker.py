"""`servoident worker`: one more process that works on the queue."""

from __future__ import annotations

import time
from typing import Annotated

import typer

from app.cli.data_options import Data, Database, settings
from ident.errors import Unusable

_PULSE = 0.5  # s, after which Ctrl-C is heard even where another thread has taken the signal


def worker(
    executor: Annotated[str, typer.Option(metavar="NAME", help="Its own name, kept over restarts.")],
    database: Database = "",
    data: Data = None,
) -> None:
    """Work on queued fits, beside a service that uses the same PostgreSQL and data folder."""
    if not database.startswith("postgres"):
        what = "a queue in SQLite is worked on by the service's own process only"
        raise Unusable("needs-postgresql", what, "--database", "give a PostgreSQL URL here and to the service")
    from app.main import make_context
    from ident.parallel import one_thread

    context = make_context(settings(data, database, executor=executor))
    with one_thread():
        context.jobs.launch()
        print(f"worker {executor} is waiting for jobs  (Ctrl-C stops it)", flush=True)
        try:
            while True:
                time.sleep(_PULSE)
        except KeyboardInterrupt:
            print("stopped; its unfinished jobs go on when it starts again")
        finally:
            context.jobs.stop()

"""`servoident worker`: one more process that works on the queue."""

from __future__ import annotations

import time
from typing import Annotated

import typer

from app.cli.data_options import Blobs, Data, Database, Log, settings
from app.cli.interrupts import ended_as_by_ctrl_c
from ident.errors import Unusable

_PULSE = 0.5  # s, after which Ctrl-C is heard even where another thread has taken the signal


def worker(
    executor: Annotated[str, typer.Option(metavar="NAME", help="Name of this worker, kept over restarts.")],
    database: Database = "",
    data: Data = None,
    blobs: Blobs = "",
    log: Log = "text",
) -> None:
    """Run queued jobs of a service.

    The worker uses the PostgreSQL database and the upload storage of the service.
    """
    if not database.startswith("postgres"):
        what = "a queue in SQLite is worked on by the service's own process only"
        raise Unusable("needs-postgresql", what, "--database", "give a PostgreSQL URL here and to the service")
    from app.main import make_context, start, stop
    from app.operation.logs import in_json
    from ident.parallel import one_thread

    if log == "json":
        in_json()
    ended_as_by_ctrl_c()
    context = make_context(settings(data, database, blobs=blobs, executor=executor, log=log))
    with one_thread():
        threads = start(context)
        print(f"worker {executor} is waiting for jobs  (Ctrl-C stops it)", flush=True)
        try:
            while context.jobs.running:
                time.sleep(_PULSE)
            remedy = "give each worker a name of its own"
            raise Unusable("name-taken", "another process works under this name", f"--executor {executor}", remedy)
        except KeyboardInterrupt:
            print("stopped; its unfinished jobs go on elsewhere, or when it starts again")
        finally:
            stop(context, threads)

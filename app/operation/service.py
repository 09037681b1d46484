"""Whether the service can work."""

from __future__ import annotations

from app.context import Context
from app.database import reachable
from app.errors import Failure


def ready(context: Context) -> None:
    """Raise Failure 503 where the service cannot work."""
    if not (reachable(context.engine) and context.jobs.running):
        raise Failure(
            503, "not-ready", "the database or the job queue is not ready", "service", "try again in a moment"
        )

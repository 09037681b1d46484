"""What an operator watches."""

from __future__ import annotations

from app.context import Context
from app.database import reachable
from app.errors import Failure
from app.jobs import repository as recorded
from app.operation import repository


def ready(context: Context) -> None:
    """Raise Failure 503 where the service cannot work."""
    if not (reachable(context.engine) and context.jobs.running):
        raise Failure(
            503, "not-ready", "the database or the job queue is not ready", "service", "try again in a moment"
        )


def metrics(context: Context) -> str:
    """Numbers of records and of jobs by state, in Prometheus' text format."""
    with context.sessions() as session:
        jobs, records = recorded.by_state(session), repository.records(session)
    lines = ["# HELP servoident_jobs Jobs by state.", "# TYPE servoident_jobs gauge"]
    lines += [f'servoident_jobs{{state="{state}"}} {count}' for state, count in sorted(jobs.items())]
    lines += ["# HELP servoident_records Stored records by kind.", "# TYPE servoident_records gauge"]
    lines += [f'servoident_records{{kind="{kind}"}} {count}' for kind, count in sorted(records.items())]
    return "\n".join(lines) + "\n"

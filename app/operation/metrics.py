"""Numbers for Prometheus: what this process counts itself, and what all of them keep in the database.

No table is counted when they are read: of jobs that ended there is a tally, of those that have not an index.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterator

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, generate_latest
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.registry import Collector

from app.context import Context
from app.operation import repository
from app.workers import repository as workers

_SECONDS = (0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 15.0, 60.0)


class Requests:
    """Counts of the requests that this process answered."""

    def __init__(self) -> None:
        self.registry = CollectorRegistry()
        labels = ("method", "route")
        self.answered = Counter(
            "servoident_requests", "Requests answered.", (*labels, "status"), registry=self.registry
        )
        self.seconds = Histogram(
            "servoident_request_seconds", "Time to answer a request.", labels, buckets=_SECONDS, registry=self.registry
        )
        self.open = Gauge("servoident_requests_open", "Requests being answered.", registry=self.registry)


class Stored(Collector):
    """Counts that outlive a process: of jobs, of the queue, of workers; and the free space."""

    def __init__(self, context: Context) -> None:
        self.context = context

    def collect(self) -> Iterator[Metric]:
        """Read them."""
        with self.context.sessions() as session:
            tallies, waiting = repository.tallies(session), workers.waiting(session)
            silent = [worker.silent for worker in workers.every(session)]
        ended = CounterMetricFamily("servoident_jobs_ended", "Jobs that ended.", labels=("kind", "state"))
        seconds = CounterMetricFamily(
            "servoident_jobs_seconds", "Time from the start of jobs to their end.", labels=("kind", "state")
        )
        for tally in tallies:
            ended.add_metric((tally.kind, tally.state), tally.jobs)
            seconds.add_metric((tally.kind, tally.state), tally.seconds)
        yield from (ended, seconds)
        yield _gauge("servoident_jobs", "Jobs that have not ended.", "state", waiting)
        counts = {"alive": silent.count(False), "silent": silent.count(True)}
        yield _gauge("servoident_workers", "Processes that work on jobs.", "state", counts)
        free = shutil.disk_usage(self.context.settings.data).free
        yield GaugeMetricFamily("servoident_free_bytes", "Free space of the data folder.", value=free)


def _gauge(name: str, meaning: str, label: str, values: dict[str, int]) -> GaugeMetricFamily:
    found = GaugeMetricFamily(name, meaning, labels=(label,))
    for key, value in values.items():
        found.add_metric((key,), value)
    return found


def text(context: Context, requests: Requests) -> bytes:
    """All of them in Prometheus' text format."""
    stored = CollectorRegistry()
    stored.register(Stored(context))
    return generate_latest(requests.registry) + generate_latest(stored)

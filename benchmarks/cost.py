"""What one actuator costs a service with PostgreSQL: its upload and its fit, in processor time and in bytes."""

from __future__ import annotations

import statistics
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path

from benchmarks import figures, process
from benchmarks.table import Table
from tests.app.conftest import archived, packed
from tests.reference import qian_reference as reference
from tests.running import TOKEN, Service, free_port, started
from tests.running_postgresql import Postgres, postgresql

RUNS, TIMES = 63, 3
LENGTHS = (2.0, 30.0)  # s a run


@dataclass(frozen=True)
class Cost:
    """Processor time (s) and bytes of one actuator."""

    upload: float
    fit: float
    database: float
    raw: float


@contextmanager
def served(folder: Path) -> Iterator[tuple[Service, int, Postgres]]:
    """A service on a PostgreSQL that waits for its disk; its process; the server."""
    with ExitStack() as stack:
        server = stack.enter_context(postgresql(durable=True))
        command = ("serve", "--port", free_port(), "--data", folder, "--database", server.url)
        running, line = stack.enter_context(started(*command, until="token=", SERVOIDENT_TOKEN=TOKEN))
        yield Service.that_said(line), running.pid, server


def of_actuator(service: Service, pid: int, server: Postgres, content: bytes) -> Cost:
    """Of an upload and a fit with the default settings; what the service does meanwhile by itself is in it."""
    postmaster = int((server.folder / "data" / "postmaster.pid").read_text().split()[0])
    began = process.processor(pid), process.processor(postmaster)
    answer = service.client.post("/matrices", files={"files": ("a.zip", content)})
    assert answer.status_code == 201, answer.text
    uploaded = process.processor(pid)
    job = service.fit(answer.json()["id"])
    assert service.ended(job)["state"] == "succeeded"
    ended = process.processor(pid), process.processor(postmaster)
    return Cost(uploaded - began[0], ended[0] - uploaded, max(ended[1] - began[1], 0.0), len(content))


def measure() -> Table:
    """Medians of a few actuators, after one that loads and compiles everything."""
    plant, trials = reference.Plant(), [one for one in reference.trials() if one.use == "fit"][:RUNS]
    rows = []
    with tempfile.TemporaryDirectory() as folder, served(Path(folder)) as (service, pid, server):
        for seconds in LENGTHS:
            records = reference.measure_all(plant, trials, seconds=seconds, noise=0.005, seed=1, hold="linear")
            assert len(records) == RUNS
            made = (archived(packed(records, f"C-{seconds:g}-{number}")) for number in range(TIMES + 1))
            _, *costs = [of_actuator(service, pid, server, content) for content in made]
            found = {name: statistics.median(asdict(each)[name] for each in costs) for name in asdict(costs[0])}
            figures.note(**{f"{name}_of_63_runs_of_{seconds:g}_s": value for name, value in found.items()})
            shown = (f"{found[name]:.2f}" for name in ("upload", "fit", "database"))
            rows.append((f"{RUNS} runs of {seconds:g} s", *shown, f"{found['raw'] / 1e6:.1f}"))
    return Table(
        "Cost of an actuator",
        f"Processor time (s) of the service and of PostgreSQL, and bytes: upload as npz and a fit of six "
        f"parameters with the default settings; medians of {TIMES}. What the service does by itself "
        "meanwhile is in it.",
        ("upload and fit of", "upload", "fit", "PostgreSQL", "raw MB"),
        rows,
        "none: docs/capacity.md is reckoned from it",
        True,
    )

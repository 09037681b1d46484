"""A service at work: line clients that ask, benches that upload and a fit at once; then the largest uploads alone."""

from __future__ import annotations

import os
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from multiprocessing import get_context
from pathlib import Path

import httpx
import numpy as np

from benchmarks import process, uploads
from benchmarks.line import questions
from benchmarks.line_filled import fill
from benchmarks.table import Table
from tests.running import TOKEN, Service, free_port, started
from tests.running_postgresql import SERVERS, postgresql

SECONDS = float(os.environ.get("BENCHMARK_SECONDS", "300"))
LINES, BENCHES, SETS, ROWS = 50, 5, 20_000, 100
SLOWEST = 500.0  # ms, p99 of the line's questions
LARGEST = {"npz": 5.0, "parquet": 5.0, "csv": 15.0}  # s from upload to findings, by kind of file
TWICE = 2.0  # times the matrix's arrays
WORK: dict[str, dict[str, int]] = {
    "one fit after the other": {},
    "one search of 10,000 × 200": {"population": 10_000, "generations": 200},
}
"""What is fitted meanwhile, with what options of the search."""


@dataclass
class Seen:
    """What the clients saw: times of what was answered (ms) and fitted (s), and what was not answered as it should."""

    questions: list[float] = field(default_factory=list)
    uploads: list[float] = field(default_factory=list)
    fits: list[float] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)


@contextmanager
def served(kind: str, folder: Path) -> Iterator[tuple[Service, int]]:
    """A service on a database with some sets in it, and its process."""
    with ExitStack() as stack:
        data = folder / "data"
        url = f"sqlite:///{data / 'servoident.sqlite'}"
        place: tuple[str, ...] = ("--data", str(data))
        if kind == "PostgreSQL":
            url = stack.enter_context(postgresql(durable=True)).url
            place += ("--database", url)
        data.mkdir(parents=True)
        fill(url, SETS).dispose()
        serve = ("serve", "--port", free_port(), *place)
        running, line = stack.enter_context(started(*serve, until="token=", SERVOIDENT_TOKEN=TOKEN))
        yield Service.that_said(line), running.pid


def under_load(service: Service, seconds: float, options: dict[str, int]) -> Seen:
    """So many seconds of everything at once; `options` of the search."""
    seen, ends = Seen(), time.monotonic() + seconds
    matrix = _sent(service.client, uploads.upload(2.0, "npz", "L-0")).json()["id"]
    fitting = threading.Thread(target=_fits, args=(service, matrix, options, ends, seen))
    fitting.start()
    with ProcessPoolExecutor(1, get_context("spawn")) as beside:  # what they do holds no question up
        benches = beside.submit(_benches, service.address, service.token, seconds)
        _at_once(lambda number: _line(service, number, ends, seen), LINES)
        uploaded = benches.result()
    seen.uploads += uploaded.uploads
    seen.errors += uploaded.errors
    fitting.join()
    return seen


def _fits(service: Service, matrix: str, options: dict[str, int], ends: float, seen: Seen) -> None:
    """One fit after the other, each from another seed; what runs at the end is cancelled."""
    with _client(service) as client:
        while time.monotonic() < ends:
            answer = client.post("/fits", json={"matrix": matrix, "seed": len(seen.fits), "options": options})
            job = answer.headers["Location"].removeprefix("/api/v1")
            began, state = time.monotonic(), "queued"
            while state in ("queued", "running") and time.monotonic() < ends:
                time.sleep(0.25)
                state = client.get(job).json()["state"]
            seen.fits.append(time.monotonic() - began)
            if state in ("queued", "running"):
                client.delete(job)
            elif state != "succeeded":
                seen.errors.append(f"a fit {state}")


def _benches(address: str, token: str, seconds: float) -> Seen:
    """What comes of everything that is uploaded for so long."""
    service = Service(address, token)
    seen, ends = Seen(), time.monotonic() + seconds
    _at_once(lambda number: _bench(service, number, ends, seen), BENCHES)
    return seen


def _at_once(act: Callable[[int], None], count: int) -> None:
    """Act so many times at once, each by its number."""
    threads = [threading.Thread(target=act, args=(number,)) for number in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def _line(service: Service, number: int, ends: float, seen: Seen) -> None:
    """A question a second; its time counts from when it was due, also where the one before was late."""
    draw, asked = np.random.default_rng(number), list(questions(SETS).values())
    due = time.monotonic() + draw.random()
    with _client(service) as client:
        while due < ends:
            time.sleep(max(0.0, due - time.monotonic()))
            ask = asked[draw.integers(len(asked))](float(draw.random()))
            _noted(seen, lambda ask=ask: client.get("/parameter-sets", params={"limit": str(ROWS), **ask}))  # type: ignore[misc]
            seen.questions.append(1e3 * (time.monotonic() - due))
            due += 1.0


def _bench(service: Service, number: int, ends: float, seen: Seen) -> None:
    """A matrix of 12 MB after the other, each new."""
    count = 0
    with _client(service) as client:
        while time.monotonic() < ends:
            content = uploads.upload(3.0, "npz", f"L-{number}-{count}")
            began = time.monotonic()
            _noted(seen, lambda content=content: _sent(client, content))  # type: ignore[misc]
            seen.uploads.append(1e3 * (time.monotonic() - began))
            count += 1


def _client(service: Service) -> httpx.Client:
    return httpx.Client(base_url=service.client.base_url, headers=service.client.headers, timeout=120)


def _sent(client: httpx.Client, content: bytes) -> httpx.Response:
    return client.post("/matrices", files={"files": ("matrix.zip", content)})


def _noted(seen: Seen, act: Callable[[], httpx.Response]) -> None:
    try:
        answer = act()
    except httpx.HTTPError as error:
        seen.errors.append(repr(error))
        return
    if answer.status_code not in (200, 201):
        seen.errors.append(f"{answer.status_code}: {answer.text[:200]}")


def largest(service: Service, pid: int, kind: str) -> tuple[float, float, float]:
    """Of an upload of 63 runs of 30 s: seconds to its findings, of processor; memory over the matrix's arrays."""
    content = uploads.upload(30.0, kind, f"L-{kind}")
    assert _sent(service.client, uploads.upload(0.5, kind, f"L-warm-{kind}")).status_code == 201
    before, busy = process.resident(pid), process.processor(pid)
    process.reset(pid)
    began = time.monotonic()
    answer = _sent(service.client, content)
    taken = time.monotonic() - began
    assert answer.status_code == 201, answer.text
    assert "findings" in answer.json()
    grown = process.peak(pid) - before
    return taken, process.processor(pid) - busy, grown / uploads.arrays(30.0)


def measure() -> tuple[Table, Table]:
    """Both databases under load; the largest uploads to a service that has nothing else to do."""
    crowd, alone = [], []
    crowd_met = alone_met = True
    for database in ("SQLite", *(("PostgreSQL",) if SERVERS else ())):
        with tempfile.TemporaryDirectory() as folder, served(database, Path(folder)) as (service, pid):
            if database == "SQLite":
                for kind, limit in LARGEST.items():
                    taken, busy, memory = largest(service, pid, kind)
                    alone.append((kind, f"{taken:.1f}", f"{busy:.1f}", f"{memory:.2f}"))
                    alone_met &= taken <= limit and memory <= TWICE
            for work, options in WORK.items():
                seen = under_load(service, SECONDS, options)
                print(*seen.errors[:20], sep="\n")
                median, late = np.percentile(seen.questions, [50, 99])
                uploaded = float(np.median(seen.uploads))
                crowd.append(
                    (
                        database,
                        work,
                        str(len(seen.questions)),
                        f"{median:.0f}",
                        f"{late:.0f}",
                        str(len(seen.uploads)),
                        f"{uploaded:.0f}",
                        str(len(seen.fits)),
                        str(len(seen.errors)),
                    )
                )
                crowd_met &= late <= SLOWEST and not seen.errors
    return (
        Table(
            "Load",
            f"{LINES} clients that ask a question a second each of {SETS:,} sets, {ROWS} rows an answer, {BENCHES} "
            f"that upload {uploads.arrays(3.0) / 1e6:.0f} MB one after the other, and fits, for "
            f"{SECONDS:g} s; "
            "clients and service share the machine. Times (ms) count from when a question was due.",
            ("database", "at work", "questions", "median", "99 %", "uploads", "median of an upload", "fits", "errors"),
            crowd,
            f"no error, 99 % of the questions in {SLOWEST:g} ms",
            crowd_met,
        ),
        Table(
            "Largest uploads",
            f"63 runs of 30 s, {uploads.arrays(30.0) / 1e6:.0f} MB of samples, from the request to 201 with its "
            "findings; memory of the service's processes at their peaks, beyond what they held, over the samples.",
            ("files", "s by the clock", "s of processor", "memory"),
            alone,
            ", ".join(f"{kind} in {limit:g} s" for kind, limit in LARGEST.items()) + f", memory ≤ {TWICE:g}",
            alone_met,
        ),
    )

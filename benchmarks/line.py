"""A production line's questions to a million parameter sets: in SQLite and in PostgreSQL.

BENCHMARK_SQLITE and BENCHMARK_POSTGRESQL name databases that are filled once and kept; BENCHMARK_SETS fills fewer.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np
from fastapi.testclient import TestClient
from scipy.stats import norm
from sqlalchemy import Engine

from app.context import Context
from app.database import connect, sessions
from app.main import create_app
from app.parameters import export
from app.parameters.repository.matching_sets import numbers
from app.parameters.set_query import SetQuery
from app.settings import Settings
from benchmarks import figures, process
from benchmarks.line_filled import PARAMETERS, fill
from benchmarks.table import Table
from tests.running_postgresql import SERVERS, postgresql

SETS, ROWS, TIMES = int(os.environ.get("BENCHMARK_SETS", "1000000")), 100, 500
TOKEN = "a-token-for-benchmarks"
IN_DATABASE, OVER_HTTP, STATISTICS, VERDICT = 10.0, 30.0, 100.0, 10.0  # ms, p95
MEMORY, BYTES = 100.0, 20_000.0  # MB of an export, bytes of a set
Asked = dict[str, str]
"""What a request asks for, as its query has it."""


def questions(sets: int = SETS) -> dict[str, Callable[[float], Asked]]:
    """Each with what it asks for, by a number from 0 to 1 that moves it about."""
    found: dict[str, Callable[[float], Asked]] = {
        "by serial": lambda at: {"serial": f"SW-{int(at * 0.29 * sets):06}"},
        "by batch": lambda at: {"batch": f"B{int(at * 999):04}"},
        "in force": lambda _: {"current": "true"},
    }
    for share in (1e-4, 1e-2, 0.5):
        for names in (("Z0",), ("Z0", "tau")):
            title = f"{len(names)} range{'s' * (len(names) > 1)} matching {100 * share:g} %"
            found[title] = lambda at, share=share, names=names: _ranges(share ** (1 / len(names)), names, at)  # type: ignore[misc]
    return found


def _ranges(share: float, names: tuple[str, ...], at: float) -> Asked:
    """Ranges that each hold this share of the values, begun somewhere."""
    lower = at * (1 - share)
    ends = {name: norm.ppf([lower, lower + share], *PARAMETERS[name][:2]) for name in names}
    asked = {f"{name}.min": repr(float(low)) for name, (low, _) in ends.items() if np.isfinite(low)}
    return asked | {f"{name}.max": repr(float(high)) for name, (_, high) in ends.items() if np.isfinite(high)}


def _wanted(asked: Asked) -> SetQuery:
    lowest = {name[:-4]: float(value) for name, value in asked.items() if name.endswith(".min")}
    highest = {name[:-4]: float(value) for name, value in asked.items() if name.endswith(".max")}
    rest: dict[str, Any] = {name: asked[name] for name in ("serial", "batch") if name in asked}
    return SetQuery(lowest=lowest, highest=highest, current=True if "current" in asked else None, **rest)


@dataclass(frozen=True)
class Taken:
    """The 95th percentiles (ms) of work that is moved about: by the clock, and of this process's processor time."""

    clock: float
    processor: float

    def __str__(self) -> str:
        return f"{self.clock:.1f} ({self.processor:.1f})"


def p95(work: Callable[[float], object], times: int = TIMES) -> Taken:
    """How long work takes; the first five times do not count."""
    taken = []
    for at in np.random.default_rng(1).random(times + 5):
        began = time.perf_counter(), time.process_time()
        work(float(at))
        taken.append((time.perf_counter() - began[0], time.process_time() - began[1]))
    return Taken(*(1e3 * np.percentile(taken[5:], 95, axis=0)))


def in_database(engine: Engine, ask: Callable[[float], Asked], page: int) -> Taken:
    """Every statement that a page is found by; `page` counts from 1, each of so many rows."""
    makers, ends = sessions(engine), cycle([None] if page == 1 else _ends(engine, ask, page))

    def work(at: float) -> None:
        with makers() as session:
            numbers(session, _wanted(ask(at)), next(ends), ROWS)

    return p95(work)


def _ends(engine: Engine, ask: Callable[[float], Asked], page: int) -> Iterator[int]:
    """The number before which the page begins, found by going there once; the last page where there are fewer."""
    with sessions(engine)() as session:
        passed = numbers(session, _wanted(ask(0.5)), None, (page - 1) * ROWS)
    yield passed[-1] if len(passed) == (page - 1) * ROWS else (passed[-ROWS:] or [SETS])[0]


def rows(url: str) -> Iterator[tuple[tuple[str, ...], bool]]:
    """A row of the table for each question, and whether its goals are met."""
    engine, kind = connect(url), "PostgreSQL" if url.startswith("postgresql") else "SQLite"
    with tempfile.TemporaryDirectory() as folder:
        settings = Settings(data=Path(folder), token=TOKEN, database_url=url, rate=0)
        headers = {"Authorization": f"Bearer {TOKEN}"}
        with TestClient(create_app(settings), "http://127.0.0.1:8000", headers=headers) as client:

            def get(path: str, **params: str) -> None:
                answer = client.get(f"/api/v1/{path}", params=params)
                assert answer.status_code == 200, answer.text

            for title, ask in questions().items():
                times = [in_database(engine, ask, page) for page in (1, 1000)]
                http = p95(lambda at, ask=ask: get("parameter-sets", limit=str(ROWS), **ask(at)))  # type: ignore[misc]
                met = max(each.clock for each in times) <= IN_DATABASE and http.clock <= OVER_HTTP
                yield (kind, title, *map(str, times), str(http)), met
            yield _export(kind, client.app.state.context)
            yield _size(kind, engine)
            found = p95(lambda at: get("statistics", parameter="Z0", batch=f"B{int(at * 999):04}"), 100)
            yield (kind, "statistics of a batch", "", "", str(found)), found.clock <= STATISTICS
            client.put("/api/v1/limits/qian2014", json={"limits": {"tau": {"upper": 3, "unit": "ms"}}})
            found = p95(lambda at: get(f"actuators/SW-{int(at * 0.29 * SETS):06}/verdict"))
            yield (kind, "verdict", "", "", str(found)), found.clock <= VERDICT
    engine.dispose()


def _export(kind: str, context: Context) -> tuple[tuple[str, ...], bool]:
    """All sets as CSV, and the most memory that it takes."""
    before, began, found = process.resident(os.getpid()), time.process_time(), -1  # the first line has the titles
    process.reset(os.getpid())
    for piece in export.csv_rows(context, SetQuery()):
        found += piece.count("\n")
    grown = (process.peak(os.getpid()) - before) / 1e6
    busy = time.process_time() - began
    title = f"export of {found:,} sets: {grown:.0f} MB of memory, {busy:.0f} s of processor"
    return (kind, title, "", "", ""), found == SETS and grown <= MEMORY


def _size(kind: str, engine: Engine) -> tuple[tuple[str, ...], bool]:
    with engine.connect() as connection:
        if kind == "SQLite":
            pages, size = (connection.exec_driver_sql(f"PRAGMA page_{name}").scalar() for name in ("count", "size"))
            total = int(pages or 0) * int(size or 0)
        else:
            total = int(connection.exec_driver_sql("SELECT pg_database_size(current_database())").scalar() or 0)
    each = total / SETS
    figures.note(**{f"bytes_a_set_{kind.lower()}": round(each)})
    return (kind, f"{each / 1e3:.1f} kB a set outside the blobs", "", "", ""), each <= BYTES


def measure() -> Table:
    """Both databases, filled anew unless they hold what is asked for; a PostgreSQL of its own where none is named."""
    with ExitStack() as stack:
        folder = stack.enter_context(tempfile.TemporaryDirectory())
        given = os.environ.get("BENCHMARK_POSTGRESQL", "")
        if SERVERS and not given:
            given = stack.enter_context(postgresql(durable=True)).url
        urls = [os.environ.get("BENCHMARK_SQLITE") or f"sqlite:///{folder}/servoident.sqlite", *([given] * bool(given))]
        for url in urls:
            if not _filled(url):
                fill(url, SETS).dispose()
        found = [row for url in urls for row in rows(url)]
    return Table(
        "Production line",
        f"{SETS:,} sets of 300 serials a thousand, 1000 batches, 6 values and 2 kB of result each; 95th percentile "
        f"(ms) of {TIMES} questions that are moved about, by the clock (and of the asker's processor time, for "
        f"PostgreSQL without the server's); {ROWS} rows a page.",
        ("database", "question", "found, page 1", "found, page 1000 or the last", "over HTTP"),
        [row for row, _ in found],
        f"found ≤ {IN_DATABASE:g}, over HTTP ≤ {OVER_HTTP:g}, statistics ≤ {STATISTICS:g}, verdict ≤ {VERDICT:g}; an "
        f"export complete in {MEMORY:g} MB, {BYTES / 1e3:g} kB a set",
        all(met for _, met in found),
    )


def _filled(url: str) -> bool:
    """Whether a database holds so many sets already."""
    engine = connect(url)
    try:
        with engine.connect() as connection:
            return connection.exec_driver_sql("SELECT max(number) FROM parameter_sets").scalar() == SETS
    except Exception:  # an empty one has no tables
        return False
    finally:
        engine.dispose()

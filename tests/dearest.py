"""What tests cost, in seconds of the processor: of their worker and of the processes that ended in them.

At the end of a run of many files the dearest are named, where to look when the run takes too long; `--costs FILE`
writes what each test cost. Processes that outlive a test (a service that a file shares) count where they end; those
that end after the last test of a worker are what its files share: the service and the browser of all stories, and what
processes are forked from.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Generator
from pathlib import Path
from typing import Any

import pytest

from tests.nursery import Nursery

SHARED = "what files share"
NAMED = 10
"""Files that are named; a run of no more has nothing to name."""

_counted: dict[int, float] = {}
"""Of each process, by its number, what was counted: a worker is a fork, and begins with nothing."""
_BEFORE = pytest.StashKey[float]()
_LAST = pytest.StashKey[bool]()


def pytest_collection_finish(session: pytest.Session) -> None:
    """All is imported and collected."""
    session.config.stash[_BEFORE] = _spent()


def pytest_runtest_logstart() -> None:
    """A test begins."""
    _spent()


def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> None:
    """With the last test ends what the tests before it shared."""
    item.stash[_LAST] = nextitem is None


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, Any, Any]:
    """Each part of a test says what it cost: to the process that reports, which is another than its worker."""
    report = yield
    report.processor, report.payer = _spent(), report.nodeid.partition("::")[0]
    if item.stash.get(_LAST, False):
        report.payer = SHARED
    return report


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """The dearest files; what each test cost, where a file for that was named."""
    costs: Counter[str] = Counter()
    of_tests: Counter[tuple[str, str]] = Counter()
    for reports in terminalreporter.stats.values():
        for report in reports:
            if hasattr(report, "processor"):
                costs[report.payer] += report.processor
                of_tests[report.nodeid if report.payer != SHARED else SHARED, report.when] += report.processor
    if len(costs) > NAMED:
        before = config.stash.get(_BEFORE, 0.0)
        told = f"{sum(costs.values()):.0f} s of the processor in tests, {before:.0f} s before the first"
        terminalreporter.section(f"{told}; the most in")
        for file, seconds in costs.most_common(NAMED):
            terminalreporter.line(f"{seconds:6.1f} s  {file}")
    if file := config.getoption("--costs"):
        lines = (f"{seconds:.3f}\t{when}\t{test}\n" for (test, when), seconds in of_tests.most_common())
        Path(file).write_text("".join(lines), encoding="utf-8")


def _spent() -> float:
    """Seconds of the processor since this was asked last."""
    own = os.getpid()
    before, _counted[own] = _counted.get(own, 0.0), sum(os.times()[:4]) + Nursery.used
    return _counted[own] - before

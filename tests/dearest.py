"""What the tests of each file cost, in seconds of the processor: of their worker and of the processes that ended in it.

Named at the end of a run of many files, where the dearest are what to look at when the run takes too long. Processes
that outlive a test (a service that a file shares) count where they end; those that end after the last test of a worker
are what its files share: the service and the browser of all stories, and what processes are forked from.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Generator
from typing import Any

import pytest

from tests.nursery import Nursery

SHARED = "what files share"
NAMED = 10
"""Files that are named; a run of no more has nothing to name."""

_counted = 0.0
_LAST = pytest.StashKey[bool]()


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


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """The dearest files."""
    costs: Counter[str] = Counter()
    for reports in terminalreporter.stats.values():
        for report in reports:
            if hasattr(report, "processor"):
                costs[report.payer] += report.processor
    if len(costs) > NAMED:
        terminalreporter.section(f"{sum(costs.values()):.0f} s of the processor in tests, the most in")
        for file, seconds in costs.most_common(NAMED):
            terminalreporter.line(f"{seconds:6.1f} s  {file}")


def _spent() -> float:
    """Seconds of the processor since this was asked last."""
    global _counted
    before, _counted = _counted, sum(os.times()[:4]) + Nursery.used
    return _counted - before

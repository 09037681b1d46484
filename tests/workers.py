"""Workers of a whole run: forks of the one process that collects the tests.

A collection takes ten seconds of a core, and half a minute in a fresh clone; so it is made once, and each worker begins
with all that is imported. A worker takes a file whenever it has run the last: the tests of a file share what they set
up. What its tests say goes through a pipe to the process that collected, which counts and prints it: the reports of a
test with the next word, since each message wakes that process. A system that cannot fork runs the tests one after
another.
"""

from __future__ import annotations

import os
import signal
import sys
import warnings
from collections import deque
from collections.abc import Iterator
from contextlib import suppress
from multiprocessing import Pipe
from multiprocessing.connection import Connection, wait
from typing import Any

import pytest
from _pytest.unraisableexception import gc_collect_iterations_key

SEARCHES = 2
"""Of the collector at each of two moments at the end, for what a finalizer may have complained of. pytest makes five,
and each looks through all that the tests left: the first finds it, the second what finalizers let go."""
Files = deque[list[int]]
"""Of each file that no worker has yet, the places of its tests among all."""


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--workers", type=int, default=1, help="processes that run files at the same time")


@pytest.hookimpl(tryfirst=True)
def pytest_runtestloop(session: pytest.Session) -> bool | None:
    """Run the tests of the session by its workers; None leaves them to pytest, which runs them in this process."""
    count = session.config.getoption("--workers")
    if count < 2 or not hasattr(os, "fork") or session.testsfailed or session.config.option.collectonly:
        return None
    files, begun = of_files(session.items), dict[Connection, int]()
    for stream in (sys.stdout, sys.stderr, session.config.get_terminal_writer()):
        stream.flush()  # or each worker writes it once more when it ends
    for _ in range(min(count, len(files))):
        ours, theirs = Pipe()
        number = os.fork()
        if number == 0:
            for other in (ours, *begun):
                other.close()
            Worker(session, theirs).work()
            return True
        theirs.close()
        begun[ours] = number
    try:
        _listen(session, files, begun)
    finally:
        for number in begun.values():
            with suppress(ProcessLookupError):
                os.kill(number, signal.SIGINT)
            os.waitpid(number, 0)
    return True


def goes_with(nodeid: str) -> str:
    """What goes to one worker with a test: its file, or the files that share a service and what it holds.

    One file of the browser has a service and a window of its own. The files of tests/app, which take longest of all,
    are two parts: those in folders of it, and those beside them.
    """
    file = nodeid.partition("::")[0]
    folder, _, name = file.rpartition("/")
    if folder == "tests/browser" and name != "test_workbench.py":
        return folder
    return "folders of tests/app" if folder.startswith("tests/app/") else folder if folder == "tests/app" else file


def of_files(items: list[pytest.Item]) -> Files:
    """The tests of each file, in the order in which the files come; those that go together are one."""
    files: dict[str, list[int]] = {}
    for place, item in enumerate(items):
        files.setdefault(goes_with(item.nodeid), []).append(place)
    return deque(files.values())


class Worker:
    """A process that runs what it is given, as a plugin of its pytest."""

    def __init__(self, session: pytest.Session, pipe: Connection) -> None:
        self.session, self.config, self.pipe = session, session.config, pipe
        self._reports: list[Any] = []

    def work(self) -> None:
        """Run file after file until there is none."""
        self.config.workerinput = {}  # type: ignore[attr-defined]  # by which plugins know a process that does not sum up
        self.config.stash[gc_collect_iterations_key] = SEARCHES
        plugins = self.config.pluginmanager
        plugins.unregister(name="terminalreporter")
        capture = plugins.getplugin("capturemanager")
        capture.stop_global_capturing()  # its file is that of all forks
        capture.start_global_capturing()
        capture.suspend_global_capture()
        plugins.register(self)
        given = self._given()
        item = next(given, None)
        while item is not None:
            following = next(given, None)
            self.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
            item = following
        self._say("ends")

    def _say(self, what: str, *said: Any) -> None:
        """A word to the process that collected, and the reports that came before it."""
        reports, self._reports = self._reports, []
        self.pipe.send((reports, what, *said))

    def _given(self) -> Iterator[pytest.Item]:
        """The tests, of one more file whenever those of a file have been handed out."""
        while True:
            self._say("next")
            places = self.pipe.recv()
            if places is None:
                return
            yield from (self.session.items[place] for place in places)

    def pytest_runtest_logstart(self, nodeid: str, location: Any) -> None:
        """A test begins."""
        self._say("begins", nodeid, location)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """A part of a test has ended."""
        data = self.config.hook.pytest_report_to_serializable(config=self.config, report=report)
        self._reports.append(data)

    def pytest_warning_recorded(
        self, warning_message: warnings.WarningMessage, when: str, nodeid: str, location: Any
    ) -> None:
        """A test warned: the class of a warning may be known to this process alone, its name goes."""
        said = (str(warning_message.message), warning_message.category.__name__, warning_message.filename)
        self._say("warning", (*said, warning_message.lineno), when, nodeid, location)


def _listen(session: pytest.Session, files: Files, begun: dict[Connection, int]) -> None:
    """Hand out files and report what is said until each worker has ended; it is then no longer among those begun."""
    hook, running, ended = session.config.hook, dict[Connection, tuple[str, Any]](), 0
    while begun:
        for pipe in wait(list(begun)):
            assert isinstance(pipe, Connection)
            try:
                reports, what, *said = pipe.recv()
            except EOFError:
                _, status = os.waitpid(begun.pop(pipe), 0)
                if pipe in running:
                    hook.pytest_runtest_logreport(report=_lost(*running.pop(pipe), status))
                    ended += 1
                continue
            for data in reports:
                report = hook.pytest_report_from_serializable(config=session.config, data=data)
                hook.pytest_runtest_logreport(report=report)
                if report.when == "teardown":
                    running.pop(pipe, None)
                    ended += 1
            if what == "next":
                pipe.send(files.popleft() if files else None)
            elif what == "begins":
                running[pipe] = (said[0], said[1])
                hook.pytest_runtest_logstart(nodeid=said[0], location=said[1])
            elif what == "warning":
                _warn(hook, *said)
        if session.shouldfail:
            raise session.Failed(session.shouldfail)
    if ended < len(session.items):
        session.shouldfail = f"{len(session.items) - ended} tests did not run, because their worker ended"
        raise session.Failed(session.shouldfail)


def _lost(nodeid: str, location: Any, status: int) -> pytest.TestReport:
    """What is reported of the test whose worker ended in it."""
    code = os.waitstatus_to_exitcode(status)
    why = f"signal {signal.Signals(-code).name}" if code < 0 else f"status {code}"
    text = f"the worker that ran {nodeid} ended with {why}"
    return pytest.TestReport(nodeid, location, {}, "failed", text, "call")


def _warn(hook: Any, warning: tuple[str, str, str, int], when: str, nodeid: str, location: Any) -> None:
    """Report a worker's warning."""
    text, name, file, line = warning
    kind = type(name, (Warning,), {})
    message = warnings.WarningMessage(kind(text), kind, file, line)
    hook.pytest_warning_recorded.call_historic(
        kwargs={"warning_message": message, "when": when, "nodeid": nodeid, "location": location}
    )

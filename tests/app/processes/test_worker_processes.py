"""Work beside the process that answers: its outcome comes back, its errors, and what becomes of it when one dies."""

from __future__ import annotations

import importlib
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest
from numba.core.registry import cpu_target

from app.errors import Removed
from app.jobs.lease import Superseded
from app.main import WORK
from app.processes import Here, Place, Stopped, WorkerProcesses
from app.processes.child import LESS
from ident.errors import Cancelled, Unusable
from ident.progress import Progress
from tests.app.processes import acts

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="module")
def apart() -> Iterator[WorkerProcesses]:
    place = WorkerProcesses(1, "ident.progress")
    yield place
    place.stop()


@pytest.fixture(params=["here", "apart"])
def place(request: pytest.FixtureRequest, apart: WorkerProcesses) -> Place:
    return apart if request.param == "apart" else Here()


def test_it_is_another_process_that_stands_back(apart: WorkerProcesses) -> None:
    """The same for one call after the other: what it has prepared is there for the next."""
    first, second = apart.call(acts.where), apart.call(acts.where)
    assert first == second
    assert first[0] != os.getpid()
    assert first[1] == min(os.nice(0) + LESS, 19)


def test_what_numba_looks_through_is_there_before_the_first_fork(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each process of a service looked through it at its first fit, for 0.2 s."""
    looked: list[str] = []
    for context in ("typing_context", "target_context"):
        monkeypatch.setattr(type(getattr(cpu_target, context)), "refresh", lambda of: looked.append(type(of).__name__))
    for module in WORK:
        monkeypatch.delitem(sys.modules, module, raising=False)
        importlib.import_module(module)
    assert looked == ["Context", "CPUContext"]


@pytest.mark.parametrize(
    "error",
    [
        Unusable("bad", "what", "where", "remedy"),
        Removed("gone", "what", "where", "remedy"),
        Cancelled(),
        MemoryError(),
        OSError(28, "No space left on device"),
        Superseded(),
    ],
)
def test_what_work_raises_is_raised(place: Place, error: BaseException) -> None:
    with pytest.raises(type(error)) as caught:
        place.call(acts.raised, error)
    assert str(caught.value) == str(error)
    assert vars(caught.value).get("what") == vars(error).get("what")
    assert getattr(caught.value, "errno", None) == getattr(error, "errno", None)


def test_an_error_that_cannot_be_sent_is_described(apart: WorkerProcesses) -> None:
    with pytest.raises(RuntimeError, match="Odd"):
        apart.call(acts.odd)
    with pytest.raises(RuntimeError, match="cannot be sent"):
        apart.call(acts.unsent)


def test_where_an_error_came_from_is_told(apart: WorkerProcesses) -> None:
    with pytest.raises(ValueError, match="x") as caught:
        apart.call(acts.raised, ValueError("x"))
    assert any("acts.py" in note for note in caught.value.__notes__)


def test_reports_are_made_here_and_end_the_work_there(place: Place) -> None:
    seen: list[int] = []

    def report(progress: Progress) -> None:
        seen.append(progress.done)
        if progress.done == 3:
            raise Cancelled

    assert place.call(acts.told, 2, report=report) == "all told"
    with pytest.raises(Cancelled):
        place.call(acts.told, 9, report=report)
    assert seen == [1, 2, 1, 2, 3]
    assert place.call(acts.told, 1, report=report) == "all told"


def test_threads_that_report_at_once_are_each_heard(apart: WorkerProcesses) -> None:
    """Two that read one pipe together tear each other's answers: a diagnosis failed by it, once in many."""
    heard: list[Progress] = []
    assert apart.call(acts.told_by_many, 4, 300, report=heard.append) == "all told"
    assert Counter(progress.stage for progress in heard) == {f"thread {thread}": 300 for thread in range(4)}


def test_work_whose_process_was_ended_is_done_again(apart: WorkerProcesses, tmp_path: Path) -> None:
    assert apart.call(acts.ended_at_first, tmp_path) == "lives"
    with pytest.raises(MemoryError):
        apart.call(acts.dies)
    assert apart.call(acts.told, 1, report=lambda _: None) == "all told"


@pytest.mark.skipif("forkserver" not in multiprocessing.get_all_start_methods(), reason="each is begun by itself here")
def test_what_begins_processes_is_begun_again() -> None:
    """It was ended, and then what works was, too."""
    place = WorkerProcesses(1, "ident.progress")
    first, _ = place.call(acts.where)
    os.kill(_begun_by(first), signal.SIGKILL)
    os.kill(first, signal.SIGKILL)
    assert place.call(acts.where)[0] != first
    place.stop()


def test_what_is_under_way_is_let_go_at_the_stop(tmp_path: Path) -> None:
    place, ended = WorkerProcesses(1, "ident.progress"), []

    def call() -> None:
        with pytest.raises(Stopped):
            place.call(acts.sleeps, tmp_path)
        ended.append(True)

    caller = threading.Thread(target=call)
    caller.start()
    pid = _worker(tmp_path)
    place.stop()
    caller.join(10)
    assert ended
    assert _gone(pid)
    with pytest.raises(Stopped):
        place.call(acts.where)


def test_it_ends_with_the_process_that_began_it(tmp_path: Path) -> None:
    """Also where that was killed, and is busy."""
    begun = f"""
from pathlib import Path
from app.processes import WorkerProcesses
from tests.app.processes import acts
WorkerProcesses(1, "ident.progress").call(acts.sleeps, Path({str(tmp_path)!r}))
"""
    parent = subprocess.Popen([sys.executable, "-c", begun], cwd=ROOT)
    pid = _worker(tmp_path)
    assert not _gone(pid, 0.0)
    parent.kill()
    parent.wait()
    assert _gone(pid)


def _begun_by(pid: int) -> int:
    """The process that forked another."""
    return int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])


def _worker(folder: Path) -> int:
    """Who works, once it has said so."""
    ends = time.monotonic() + 60
    while time.monotonic() < ends:
        if (folder / "pid").exists() and (folder / "pid").read_text():
            return int((folder / "pid").read_text())
        time.sleep(0.02)
    raise AssertionError("nobody works")


def _gone(pid: int, patience: float = 10.0) -> bool:
    """Whether a process ends in time."""
    ends = time.monotonic() + patience
    while True:
        try:
            os.kill(pid, 0)
        except ProcessLookupError:
            return True
        if Path(f"/proc/{pid}/stat").exists() and Path(f"/proc/{pid}/stat").read_text().split()[2] == "Z":
            return True
        if time.monotonic() > ends:
            return False
        time.sleep(0.02)

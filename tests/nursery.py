"""Processes of the program that start within a tenth of a second: all that they import was imported once.

Each is a fork of one that has done nothing yet but import, with a life, memory, environment and threads of its own, so
that a start and a kill cost what they do and not what the imports do: five seconds of a core, with the processes in
which a service works things out. Requests are lines of JSON on standard input, and so are answers on standard output.
The workers of a run have one in common, which they inherit, and ask it in turn.
"""

from __future__ import annotations

import gc
import importlib
import json
import multiprocessing.util
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from multiprocessing import forkserver, resource_tracker
from pathlib import Path
from typing import Any, ClassVar

IMPORTED = ("app.cli.program", "app.main", "app.operation.migration", "ident.workflows", "uvicorn.protocols.http.auto",
            "uvicorn.loops.auto", "uvicorn.lifespan.on", "psycopg", "obstore", "dbos", "app.fits.work",
            "app.diagnoses.work", "app.kinds", "ident.simulation.numba_preload")  # fmt: skip
COMMAND = "from app.cli.program import main; main()"
WAIT = 240.0  # s, for a machine that is busy with other things


class Nursery:
    """Starts them; `environment` is that of all."""

    used: ClassVar[float] = 0.0
    """Seconds of the processor that those took which have ended, of all nurseries that are open."""

    def __init__(self, environment: Mapping[str, str]) -> None:
        called, root = [sys.executable, "-m", "tests.nursery"], Path(__file__).resolve().parents[1]
        self._turn, self._made_by = threading.Lock(), os.getpid()
        self._parent = subprocess.Popen(
            called, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=dict(environment), text=True, cwd=root
        )
        self._own = 0.0

    def start(
        self,
        log: Path,
        *arguments: str,
        code: str = COMMAND,
        first: str = "",
        stderr: Path | None = None,
        environment: Mapping[str, str] | None = None,
    ) -> int:
        """A new process, as ``python -c CODE ARGUMENTS``: by default a command; its number.

        What it says goes to `log`, and its errors to `stderr` where they are to be apart; what is done `first` holds
        in the processes that work for it, too.
        """
        for written in (log, stderr or log):
            written.touch()
        said = {"out": str(log.resolve()), "err": str((stderr or log).resolve())}
        asked = {"code": code, "first": first, "arguments": arguments, "folder": os.getcwd(), **said}
        number: int = self._ask(asked | ({"environment": dict(environment)} if environment is not None else {}))
        return number

    def ended(self, number: int, within: float = WAIT) -> int:
        """The exit status of a process when it has ended. Raises TimeoutError."""
        deadline = time.monotonic() + within
        while (found := self._ask({"ended": number})) is None:
            if time.monotonic() > deadline:
                raise TimeoutError(f"process {number} goes on")
            time.sleep(0.01)
        status, used = found
        self._own += used
        Nursery.used += used
        return status

    def kill(self, number: int) -> None:
        """End one in the middle of whatever it does; it is gone afterwards."""
        with suppress(ProcessLookupError):
            os.kill(number, signal.SIGKILL)
            self.ended(number)

    def close(self) -> None:
        """Start no more; a fork of who made it leaves it to the others."""
        if os.getpid() != self._made_by:
            return
        self._parent.kill()
        self._parent.wait()
        Nursery.used -= self._own  # which counts for the parent from here on, and so for this process

    def _ask(self, asked: dict[str, Any]) -> Any:
        assert self._parent.stdin is not None
        assert self._parent.stdout is not None
        with self._turn, _in_turn():
            print(json.dumps(asked), file=self._parent.stdin, flush=True)
            return json.loads(self._parent.stdout.readline())


def main() -> None:
    """Do what is asked for until nobody asks any more."""
    gc.disable()
    for name in IMPORTED:
        importlib.import_module(name)
    importlib.import_module("app.main").routed()  # with which all calls of the service are imported
    gc.freeze()
    gc.enable()
    resource_tracker.ensure_running()
    for line in sys.stdin:
        asked = json.loads(line)
        if "ended" in asked:
            print(json.dumps(_ended(asked["ended"])), flush=True)
            continue
        number = os.fork()
        if number == 0:
            _become(**asked)
            break
        print(number, flush=True)


@contextmanager
def _in_turn() -> Iterator[None]:
    """A block that one process at a time goes through."""
    import fcntl

    with open(__file__, "rb") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        try:
            yield
        finally:  # by name: a process that was forked meanwhile has the file open, too
            fcntl.flock(lock, fcntl.LOCK_UN)


def _ended(number: int) -> tuple[int, float] | None:
    """Exit status and seconds of the processor of a process that ended, None where it goes on."""
    found, status, used = os.wait4(number, os.WNOHANG)
    return (os.waitstatus_to_exitcode(status), used.ru_utime + used.ru_stime) if found else None


def _become(
    code: str,
    first: str,
    arguments: Sequence[str],
    folder: str,
    out: str,
    err: str,
    environment: Mapping[str, str] | None = None,
) -> None:
    """This fork, as the process would be that was started by itself."""
    os.setsid()
    os.chdir(folder)
    nothing = os.open(os.devnull, os.O_RDONLY)
    said, complained = (os.open(name, os.O_WRONLY | os.O_CREAT | os.O_APPEND) for name in (out, err))
    for own, other in ((0, nothing), (1, said), (2, complained)):
        os.dup2(other, own)
    if environment is not None:
        os.environ.clear()
        os.environ.update(environment)
    names = {"__name__": "__main__"}
    exec(first, names)
    with suppress(AttributeError):
        _serve_forks()
    sys.argv = ["-c", *arguments]
    exec(code, names)


def _serve_forks() -> None:
    """The process from which a service forks those that work things out: a fork, too, instead of one that imports."""
    spawned = multiprocessing.util.spawnv_passfds

    def forked(_: str, called: Sequence[str], kept: Sequence[int]) -> int:
        number = os.fork()
        if number:
            return number
        first = 3
        for held in sorted(kept):
            os.closerange(first, held)
            first = held + 1
        os.closerange(first, os.sysconf("SC_OPEN_MAX"))
        with suppress(SystemExit):  # the way in which a server of forks ends
            exec(called[-1], {"__name__": "__main__"})
        os._exit(0)

    multiprocessing.util.spawnv_passfds = forked
    forkserver.ensure_running()
    multiprocessing.util.spawnv_passfds = spawned


if __name__ == "__main__":
    main()

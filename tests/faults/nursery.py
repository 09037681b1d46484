"""Processes of the command line that start within a tenth of a second: all that they import was imported once.

Each is a fork of one that has done nothing yet but import, with a life, memory and threads of its own, so that a kill
costs the time of a start and not that of the imports. A line of JSON on standard input is one to start: the file of its
log, then its arguments; its number is printed.
"""

from __future__ import annotations

import importlib
import json
import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

IMPORTED = ("app.cli.program", "app.main", "app.operation.migration", "ident.workflows", "uvicorn.protocols.http.auto",
            "uvicorn.loops.auto", "uvicorn.lifespan.on", "psycopg", "obstore", "dbos", "app.fits.work",
            "app.diagnoses.work")  # fmt: skip


class Nursery:
    """Starts them; `environment` is theirs."""

    def __init__(self, environment: dict[str, str]) -> None:
        command = [sys.executable, "-m", "tests.faults.nursery"]
        self._parent = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment, text=True
        )

    def start(self, log: Path, *arguments: str) -> int:
        """A new process; its number."""
        assert self._parent.stdin is not None
        assert self._parent.stdout is not None
        print(json.dumps([str(log), *arguments]), file=self._parent.stdin, flush=True)
        return int(self._parent.stdout.readline())

    def kill(self, number: int) -> None:
        """End one in the middle of whatever it does; it is gone afterwards."""
        with suppress(ProcessLookupError):
            while True:
                os.kill(number, signal.SIGKILL)
                time.sleep(0.01)

    def close(self) -> None:
        """Start no more."""
        self._parent.kill()
        self._parent.wait()


def main() -> None:
    """Start what is asked for until nobody asks any more."""
    for name in IMPORTED:
        importlib.import_module(name)
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for them
    for line in sys.stdin:
        log, *arguments = json.loads(line)
        number = os.fork()
        if number == 0:
            _become(log, arguments)
        print(number, flush=True)


def _become(log: str, arguments: list[str]) -> None:
    """This fork, as the command would be that was started by itself."""
    from app.cli.program import main as command

    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    written = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    nothing = os.open(os.devnull, os.O_RDONLY)
    for own, other in ((0, nothing), (1, written), (2, written)):
        os.dup2(other, own)
    try:
        command(arguments)
    finally:
        os._exit(0)


if __name__ == "__main__":
    main()

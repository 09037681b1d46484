"""A PostgreSQL server of the tests' own, which can be stopped and started."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import mkdtemp

from tests.running import free_port

SERVERS = sorted(Path("/usr/lib/postgresql").glob("*/bin/pg_ctl"))
MISSING = "PostgreSQL is not installed (apt-get install postgresql)"


class Postgres:
    """A new server; `within` is a command that runs another, in a network namespace say; `above` holds its folder.

    One that is `durable` waits for the disk, as one that is relied on does.
    """

    def __init__(
        self, host: str = "127.0.0.1", within: Sequence[str] = (), above: Path = Path("/tmp"), durable: bool = False
    ) -> None:
        self.folder = Path(mkdtemp(prefix="servoident-pg-", dir=above))  # short, for its socket
        self.binaries, self.port, self.within = SERVERS[-1].parent, free_port(), within
        self.url = f"postgresql://postgres@{host}:{self.port}/postgres"
        self.options = (
            f"-p {self.port} -k {self.folder} -c listen_addresses={host} -c fsync={'on' if durable else 'off'}"
        )
        self.folder.chmod(0o700)
        if os.geteuid() == 0:
            shutil.chown(self.folder, "postgres")
        data = self.folder / "data"
        self._as_owner(self.binaries / "initdb", "-D", data, "-A", "trust", "-U", "postgres")
        with (data / "pg_hba.conf").open("a", encoding="utf-8") as file:
            file.write("host all all samenet trust\n")

    def start(self) -> None:
        """Start it on its data: also again."""
        log = self.folder / "log"
        self._control("-o", self.options, "-l", log, "-w", "start")

    def stop(self, how: str = "fast") -> None:
        """Stop it: "fast" ends every connection, "immediate" does as a crash does."""
        self._control("-m", how, "-w", "stop")

    def revive(self) -> None:
        """Start it again where it has ended by itself, as it does for want of room."""
        status = [*self._other(), str(self.binaries / "pg_ctl"), "-D", str(self.folder / "data"), "status"]
        if subprocess.run(status, cwd="/", capture_output=True, check=False).returncode:
            self.start()

    def remove(self) -> None:
        """Stop it and remove its data."""
        if (self.folder / "data" / "postmaster.pid").exists():
            self.stop("immediate")
        shutil.rmtree(self.folder)

    def _control(self, *arguments: object) -> None:
        self._as_owner(self.binaries / "pg_ctl", "-D", self.folder / "data", *arguments)

    def _as_owner(self, *command: object) -> None:
        """Run a program of PostgreSQL, which refuses to run as root."""
        called = [*self._other(), *map(str, command)]
        done = subprocess.run(called, cwd="/", capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr

    def _other(self) -> list[str]:
        return [*self.within, *(["runuser", "-u", "postgres", "--"] if os.geteuid() == 0 else [])]


@contextmanager
def postgresql(
    host: str = "127.0.0.1", within: Sequence[str] = (), above: Path = Path("/tmp"), durable: bool = False
) -> Iterator[Postgres]:
    """A running server, which is gone at the end."""
    server = Postgres(host, within, above, durable)
    try:
        server.start()
        yield server
    finally:
        server.remove()

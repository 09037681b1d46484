"""The service and its workers as processes that faults strike, with all that they stand on."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import httpx

from benchmarks.process import family
from tests.faults.disk import Disk, disk
from tests.nursery import Nursery
from tests.running import TOKEN, free_port
from tests.running_postgresql import Postgres, postgresql
from tests.running_s3 import S3, s3

CLOCK = Path(__file__).with_name("stepped_clock.c")
PATIENCE = 120.0  # s for a process to start
ROOM = 512  # MB of the disk for the data folder, and of that for PostgreSQL


class World:
    """A service, with two workers where there is PostgreSQL, each killed and started again under its name."""

    def __init__(self, folder: Path, server: Postgres | None, store: S3 | None, disks: tuple[Disk | None, ...]) -> None:
        self.folder, self.server, self.store = folder, server, store
        self.port, self.clock = free_port(), folder / "clock"
        self.disks = [disk for disk in disks if disk]
        self.data = (disks[0].folder if disks[0] else folder) / "data"
        self.clock.write_text("0", encoding="utf-8")
        self.shim = built(folder)
        self.names = ("servoident-1", "one", "two") if server else ("servoident-1",)
        self.http = httpx.Client(timeout=10)  # one: the certificates, which nothing here shows, are read for each
        self.nursery = Nursery(self.environment())
        self.processes: dict[str, int] = {}

    @property
    def address(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    @property
    def place(self) -> tuple[str, ...]:
        """The options that every command takes."""
        place = ("--data", str(self.data))
        if self.server:
            place += ("--database", self.server.url)
        return (*place, "--blobs", self.store.url) if self.store else place

    def start(self, name: str) -> None:
        """Start a process under its name."""
        options = (*self.place, "--executor", name)
        serve = ("serve", "--port", str(self.port), "--reserve", "0", *options)
        command = serve if name == self.names[0] else ("worker", *options)
        self.processes[name] = self.nursery.start(self.folder / f"{name}.log", *command)

    def environment(self) -> dict[str, str]:
        """That of the processes: the token, the keys of S3, and a clock that can be stepped."""
        own = os.environ | {"SERVOIDENT_TOKEN": TOKEN} | (self.store.environment if self.store else {})
        if self.shim is not None:
            own |= {"LD_PRELOAD": str(self.shim), "CLOCK_STEP": str(self.clock)}
        return own

    def kill(self, name: str) -> None:
        """End a process in the middle of whatever it does."""
        self.nursery.kill(self.processes[name])

    def signal(self, name: str, what: signal.Signals) -> None:
        os.kill(self.processes[name], what)

    def beside(self, name: str) -> list[int]:
        """What works for a process beside it."""
        return [number for number in family(self.processes[name]) if number != self.processes[name]]

    def kept(self) -> None:
        """Take from the disk what is to be looked at later."""
        if self.data.parent != self.folder:
            shutil.copytree(self.data, self.folder / "data", dirs_exist_ok=True)

    def until_ready(self) -> None:
        """Wait for the service."""
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            try:
                if self.http.get(f"{self.address}/api/v1/ready").status_code == 200:
                    return
            except httpx.TransportError:
                pass
            time.sleep(0.1)
        raise TimeoutError("the service is not ready")

    def command(self, *arguments: str) -> str:
        """What a command on the world's records prints."""
        said = self.folder / "said"
        said.unlink(missing_ok=True)
        assert self.nursery.ended(self.nursery.start(said, *arguments, *self.place)) == 0, said.read_text()
        return said.read_text()


def built(folder: Path) -> Path | None:
    """The library by which a process's clock is stepped; None where no compiler is there."""
    compiler, made = shutil.which("cc"), folder / "stepped_clock.so"
    if compiler is None:
        return None
    subprocess.run([compiler, "-O1", "-shared", "-fPIC", "-o", made, CLOCK], check=True)
    return made


@contextmanager
def world(folder: Path, database: str, *, in_s3: bool, on_disks: bool) -> Iterator[World]:
    """A running world, which has ended with the block; on disks of its own where it may."""
    with ExitStack() as stack:
        on_postgresql = database == "postgresql"
        wanted = (on_disks, on_disks and on_postgresql)
        disks = tuple(stack.enter_context(disk(ROOM)) if each else None for each in wanted)
        above = disks[1].folder if disks[1] else Path("/tmp")
        server = stack.enter_context(postgresql(above=above)) if on_postgresql else None
        store = stack.enter_context(s3()) if in_s3 else None
        made = World(folder, server, store, disks)
        try:
            for name in made.names:
                made.start(name)
            made.until_ready()
            yield made
        finally:
            for name in made.processes:
                made.kill(name)
            made.nursery.close()
            made.http.close()
            made.kept()

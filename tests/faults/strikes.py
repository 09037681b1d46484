"""What strikes the processes under load, and for how long."""

from __future__ import annotations

import os
import random
import signal
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import httpx

from tests.faults.world import World
from tests.running import TOKEN


@dataclass
class Struck:
    """What was done, and how long a job of a lost worker waited for another (s)."""

    kills: dict[str, int] = field(default_factory=dict)
    others: dict[str, int] = field(default_factory=dict)
    moved: list[float] = field(default_factory=list)


class Strikes:
    """Kills at random moments, and between them what else goes wrong in years."""

    def __init__(self, world: World, seed: int, seconds: float, between: float) -> None:
        self.world, self.draw, self.seconds, self.between = world, random.Random(seed), seconds, between
        self.struck = Struck()

    def run(self, kills: int) -> Struck:
        """So many kills; every other fault that is possible here about once in eight, each at least once."""
        others = [fault for fault, possible in self._faults() if possible]
        turns = [None] * kills + others * max(1, kills // (8 * max(1, len(others))))
        self.draw.shuffle(turns)
        for turn in turns:
            time.sleep(self.draw.uniform(0.2, self.between))
            if turn is None:
                self._kill()
            else:
                turn()
                name = turn.__name__.strip("_")
                self.struck.others[name] = self.struck.others.get(name, 0) + 1
        return self.struck

    def _faults(self) -> list[tuple[Callable[[], None], bool]]:
        return [
            (self._database_away, self.world.server is not None),
            (self._worker_frozen, self.world.server is not None),
            (self._store_refuses, self.world.store is not None),
            (self._clock_ahead, self.world.shim is not None),
            (self._clock_behind, self.world.shim is not None),
            (self._disks_full, bool(self.world.disks)),
            (self._beside_killed, Path("/proc").is_dir()),
        ]

    def _kill(self) -> None:
        """kill -9 of one; of a worker that has a job, it is started again when another has the job."""
        name = self.draw.choice(self.world.names)
        job = self._job_of(name) if name != self.world.names[0] else None
        self.world.kill(name)
        self.struck.kills[name] = self.struck.kills.get(name, 0) + 1
        if job is not None and self.draw.random() < 0.3:
            self._watch(job, name)
        time.sleep(self.draw.uniform(0.0, 0.5))
        self.world.start(name)
        if name == self.world.names[0]:
            self.world.until_ready()

    def _watch(self, job: str, lost: str) -> None:
        """How long it takes until another process has a job, or has ended it."""
        began = time.monotonic()
        while time.monotonic() - began < 60:
            found = self._asked(f"/jobs/{job}")
            if found.get("state") in ("succeeded", "failed", "cancelled") or self._holder(job) not in (None, lost):
                self.struck.moved.append(time.monotonic() - began)
                return
            time.sleep(0.1)
        self.struck.moved.append(60.0)

    def _job_of(self, name: str) -> str | None:
        workers = self._asked("/workers").get("workers", ())
        return next((worker["job"] for worker in workers if worker["name"] == name), None)

    def _holder(self, job: str) -> str | None:
        workers = self._asked("/workers").get("workers", ())
        return next((worker["name"] for worker in workers if worker["job"] == job), None)

    def _asked(self, path: str) -> dict[str, object]:
        try:
            answer = self.world.http.get(
                f"{self.world.address}/api/v1{path}", headers={"Authorization": f"Bearer {TOKEN}"}
            )
            return dict(answer.json()) if answer.status_code == 200 else {}
        except (httpx.HTTPError, ValueError):
            return {}

    def _database_away(self) -> None:
        assert self.world.server is not None
        self.world.server.stop(self.draw.choice(("fast", "immediate")))
        time.sleep(self.seconds)
        self.world.server.start()

    def _worker_frozen(self) -> None:
        name = self.draw.choice(self.world.names[1:])
        self.world.signal(name, signal.SIGSTOP)
        time.sleep(3 * self.seconds)
        self.world.signal(name, signal.SIGCONT)

    def _store_refuses(self) -> None:
        assert self.world.store is not None
        self.world.store.refuse(True)
        time.sleep(self.seconds)
        self.world.store.refuse(False)

    def _disks_full(self) -> None:
        """No room for uploads, records or queue; PostgreSQL may end by that, and is started as an operator would."""
        for disk in self.world.disks:
            disk.fill()
        time.sleep(self.seconds)
        for disk in self.world.disks:
            disk.free()
        if self.world.server:
            time.sleep(1)
            self.world.server.revive()

    def _beside_killed(self) -> None:
        """kill -9 of what reads uploads or works on jobs for the service, or of what begins those."""
        beside = self.world.beside(self.world.names[0])
        if beside:
            with suppress(ProcessLookupError):
                os.kill(self.draw.choice(beside), signal.SIGKILL)

    def _clock_ahead(self) -> None:
        self._clock(3600)

    def _clock_behind(self) -> None:
        self._clock(-3600)

    def _clock(self, step: int) -> None:
        self.world.clock.write_text(str(step), encoding="utf-8")
        time.sleep(self.seconds)
        self.world.clock.write_text("0", encoding="utf-8")

"""A mixed load: uploads, fits, diagnoses, approvals, cancellations, the same key twice; each until it is answered."""

from __future__ import annotations

import random
import threading
import time
from dataclasses import dataclass, field
from typing import Any

import httpx

from tests.app.conftest import zipped
from tests.running import ENDED, TOKEN

SEARCH = {"generations": 12, "population": 40}
SEEDS = (1, 2)
SERIALS = ("F-1", "F-2")
PAUSE = 0.3  # s between what a client asks, on the average
PATIENCE = 300.0  # s for an answer
TIMES = ("seconds", "created_at", "approved_at", "ended_at", "started_at")


@dataclass(frozen=True)
class Asked:
    """A job that was acknowledged: what it was asked, and what is expected of it."""

    job: str
    kind: str
    of: tuple[str, int]
    cancelled: bool = False


@dataclass
class Account:
    """What was asked and answered."""

    asked: list[Asked] = field(default_factory=list)
    uploads: set[str] = field(default_factory=set)
    twins: int = 0
    approvals: int = 0
    wrong: list[str] = field(default_factory=list)


class Client:
    """A client that asks again, under the same key, until it is answered."""

    def __init__(self, address: str) -> None:
        self.http = httpx.Client(base_url=f"{address}/api/v1", headers={"Authorization": f"Bearer {TOKEN}"}, timeout=30)
        self.refused = 0

    def asked(self, method: str, path: str, key: str = "", **content: Any) -> httpx.Response:
        """The answer. Raises TimeoutError where there is none for long."""
        headers = {"Idempotency-Key": key} if key else {}
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            try:
                answer = self.http.request(method, path, headers=headers, **content)
            except httpx.TransportError:
                time.sleep(0.1)
                continue
            if answer.status_code < 500:
                return answer
            self.refused += 1
            time.sleep(0.2)
        raise TimeoutError(f"{method} {path} is not answered")


class Load:
    """One client's share of the load, in a thread; its draws follow from the seed."""

    def __init__(
        self, address: str, seed: int, matrices: dict[str, str], fits: dict[tuple[str, int], str], diagnoses: bool
    ) -> None:
        self.client, self.account = Client(address), Account()
        self.draw, self.matrices, self.fits = random.Random(seed), matrices, fits
        self.weights = (9, 2, 2, 2, 3, 0.2 * diagnoses)
        self._open: list[str] = []
        self._count = 0
        self.stopping = threading.Event()
        self.thread = threading.Thread(target=self._run, daemon=True)

    def _run(self) -> None:
        try:
            self._ask()
        except Exception as error:  # it is counted, where a thread would end unheard
            self.account.wrong.append(f"{type(error).__name__}: {error}")

    def _ask(self) -> None:
        kinds = (self._fit, self._twins, self._upload, self._cancel, self._approve, self._diagnose)
        while not self.stopping.is_set():
            self.draw.choices(kinds, self.weights)[0]()
            self._throttle()
            time.sleep(self.draw.uniform(0.0, 2 * PAUSE))

    def _throttle(self) -> None:
        """Wait while three jobs of one's own are open: the load is steady, not a heap that grows."""
        while not self.stopping.is_set():
            states = {job: self.client.asked("GET", f"/jobs/{job}").json().get("state") for job in self._open}
            self._open = [job for job, state in states.items() if state not in ENDED]
            if len(self._open) < 3:
                return
            time.sleep(0.2)

    def _key(self) -> str:
        self._count += 1
        return f"{id(self)}-{self._count}-{self.draw.random()}"

    def _queued(self, path: str, kind: str, of: tuple[str, int], body: dict[str, Any], key: str) -> str:
        answer = self.client.asked("POST", path, key, json=body)
        assert answer.status_code == 202, answer.text
        job = str(answer.json()["id"])
        if job not in self._open:
            self._open.append(job)
            self.account.asked.append(Asked(job, kind, of))
        return job

    def _fit(self, key: str = "", of: tuple[str, int] | None = None) -> str:
        of = of or (self.draw.choice(SERIALS), self.draw.choice(SEEDS))
        body = {"matrix": self.matrices[of[0]], "seed": of[1], "options": SEARCH}
        return self._queued("/fits", "fit", of, body, key or self._key())

    def _twins(self) -> None:
        """The same key twice: one job."""
        key, of = self._key(), (self.draw.choice(SERIALS), self.draw.choice(SEEDS))
        first, second = self._fit(key, of), self._fit(key, of)
        assert first == second, f"{key} made {first} and {second}"
        self.account.twins += 1

    def _upload(self) -> None:
        """A new actuator's matrix now and then, else one that is known."""
        serial = f"U-{self.draw.randrange(40)}"
        answer = self.client.asked("POST", "/matrices", self._key(), files={"files": ("a.zip", zipped(serial))})
        assert answer.status_code in (200, 201), answer.text
        self.account.uploads.add(str(answer.json()["id"]))

    def _cancel(self) -> None:
        if self._open:
            job = self.draw.choice(self._open)
            assert self.client.asked("DELETE", f"/jobs/{job}").status_code == 200
            self.account.asked = [
                Asked(one.job, one.kind, one.of, cancelled=one.cancelled or one.job == job)
                for one in self.account.asked
            ]

    def _approve(self) -> None:
        fit = self.fits[self.draw.choice(SERIALS), self.draw.choice(SEEDS)]
        answer = self.client.asked("POST", f"/fits/{fit}/approve", self._key())
        assert answer.status_code == 200, answer.text
        self.account.approvals += 1

    def _diagnose(self) -> None:
        of = (SERIALS[0], SEEDS[0])
        body = {"fit": self.fits[of], "max_effects": 1, "seed": 1}
        self._queued("/diagnoses", "diagnosis", of, body, self._key())


def timeless(found: Any) -> Any:
    """A result without its times and names."""
    if isinstance(found, dict):
        return {name: timeless(value) for name, value in found.items() if name not in (*TIMES, "id", "fit", "parent")}
    return [timeless(one) for one in found] if isinstance(found, list) else found

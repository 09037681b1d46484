"""Damaged files of every kind to a service over HTTP, counted.

`python -m tests.hostile --files 5000 --seed 1`; exit status 1 where one was answered with 5xx or late, memory grew, or
anything was left behind.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import httpx

from benchmarks.process import resident
from tests.app.conftest import archived
from tests.hostile.mutated import mutated, whole
from tests.running import Process, process

SETTLED, LATEST, GROWTH = 500, 10.0, 1.1  # files after which memory is compared; s for an answer; times


Sent = tuple[str, int, float]
"""What was harmed in a file, the status of the answer, and the seconds until it came."""


@dataclass
class Counted:
    """What came of the files."""

    files: int
    statuses: dict[int, int]
    wrong: list[str]
    slowest: float
    settled: int
    resident: int
    left: list[str]

    @property
    def holds(self) -> bool:
        """Whether every file was refused or taken, soon, and nothing stayed behind."""
        return not (self.wrong or self.left) and self.slowest <= LATEST and self.resident <= GROWTH * self.settled


def run(folder: Path, files: int, seed: int) -> Counted:
    """So many files, one after the other, to a service of their own."""
    statuses: Counter[int] = Counter()
    wrong, slowest, settled = [], 0.0, 0
    with process(folder / "data") as service:
        for number, (what, status, taken) in enumerate(sent(service.client, folder / "whole", files, seed), 1):
            slowest = max(slowest, taken)
            statuses[status] += 1
            if status >= 500 or taken > LATEST:
                wrong.append(f"file {number}, {what}: {status} after {taken:.1f} s")
            if number == min(SETTLED, files):
                settled = resident(service.number)
        held = resident(service.number)
        left = left_behind(service)
    return Counted(files, dict(statuses), wrong, slowest, settled, held, left)


def sent(client: httpx.Client, folder: Path, files: int, seed: int, at: str = "/matrices") -> Iterator[Sent]:
    """Each file that was sent, after one of each kind that is unharmed."""
    matrices = whole(folder)
    for kind, unharmed in matrices.items():
        answer = client.post(at, files={"files": ("a.zip", archived(unharmed))})
        assert answer.status_code in (200, 201), f"{kind}: {answer.text}"
    for what, content in mutated(matrices, files, seed):
        began = time.monotonic()
        answer = client.post(at, files={"files": ("a.zip", content)})
        yield what, answer.status_code, time.monotonic() - began


def left_behind(service: Process) -> list[str]:
    """Files that are half written, or that no record names."""
    halves = [str(file) for pattern in ("staged-*", "*.part") for file in (service.data / "blobs").glob(pattern)]
    command = [sys.executable, "-m", "app.cli", "tidy", "--older-than", "0", "--data", str(service.data)]
    shown = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return halves + ([] if shown.startswith("0 ") else shown.splitlines())


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.hostile", description=__doc__)
    parser.add_argument("--files", type=int, default=5000)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        found = run(Path(folder), given.files, given.seed)
    for name, value in asdict(found).items():
        print(f"{name}: {value}")
    return 0 if found.holds else 1


if __name__ == "__main__":
    sys.exit(main())

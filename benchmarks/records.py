"""Measured records from the folder to the verdict, and to what is proposed beyond the catalogue; a process each.

BENCHMARK_RECORDS names the sets to take, all of them where it is not there; `python -m benchmarks.records FOLDER`
measures one and prints what it took as JSON.
"""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import scipy.signal

from benchmarks.table import Table
from ident.diagnosis.structure_selection import choose_structure
from ident.fit.settings import Settings
from ident.progress import Progress
from ident.readers import read_matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.measured.judged import KNOWN

ROOT = Path(__file__).resolve().parents[1]
DATA = ROOT.parent / "shared" / "data"
VERDICT, PROPOSED, MEMORY = 60.0, 120.0, 1e9
"""Goals: s by the clock to the verdict, s with proposals, bytes."""
LONG = 100_000
"""Samples of all runs above which a record may take twice as long."""
HEAD = ("samples", "verdict", "with proposals", "times `lfilter`", "memory", "model", "named", "standing", "complete",
        "goal")  # fmt: skip
ABSENT = "not there"
LONGEST = 900.0
"""s by the clock after which a record is given up."""


@dataclass(frozen=True)
class Measured:
    """What a process measured: clock and processor (s) to the verdict and in all, and `lfilter`'s processor time."""

    samples: int
    verdict: tuple[float, float]
    whole: tuple[float, float]
    memory: float
    lfilter: float
    complete: bool
    model: str
    named: tuple[str, ...]
    standing: str

    @property
    def in_time(self) -> bool:
        """Whether it is complete and keeps the goals of its length."""
        longer = 2.0 if self.samples > LONG else 1.0
        soon = self.verdict[0] <= longer * VERDICT and self.whole[0] <= longer * PROPOSED
        return self.complete and soon and self.memory <= MEMORY

    @property
    def row(self) -> tuple[str, ...]:
        """The cells of the table behind the name."""
        return (
            f"{self.samples:,}",
            f"{self.verdict[0]:.0f} / {self.verdict[1]:.0f} s",
            f"{self.whole[0]:.0f} / {self.whole[1]:.0f} s",
            f"{self.whole[1] / self.lfilter:,.0f}",
            f"{self.memory / 1e9:.2f} GB",
            self.model,
            ", ".join(self.named) or "–",
            self.standing,
            "yes" if self.complete else "no",
            "met" if self.in_time else "**missed**",
        )


def measured_here(folder: Path) -> Measured:
    """What a folder takes in this process, which has done nothing else before."""
    begun = _clocks()
    verdict: list[tuple[float, float]] = []

    def heard(progress: Progress) -> None:
        if progress.verdict and not verdict:
            verdict.append(_since(begun))

    choice = choose_structure(read_matrix(folder))
    settings = Settings(model=choice.structures[0].machine)
    fit = choice.made(settings) or identify(choice.matrix, settings)
    found = diagnose(choice.matrix, fit, report=heard)
    whole, runs = _since(begun), choice.matrix.runs
    return Measured(
        samples=sum(run.length for run in runs), verdict=verdict[0] if verdict else whole, whole=whole,
        memory=1024.0 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, lfilter=filtering(runs),
        complete=found.complete, model=fit.model, named=tuple(found.verdict.effects),
        standing=str(found.verdict.standing).replace("_", "-"),
    )  # fmt: skip


def filtering(runs: Sequence[Run]) -> float:
    """Processor time (s) of one `lfilter` of second order over what runs measured, the least of seven."""
    b, a = scipy.signal.butter(2, 0.1)

    def once() -> float:
        begun = time.process_time()
        for run in runs:
            scipy.signal.lfilter(b, a, run.measured)
        return time.process_time() - begun

    return max(min(once() for _ in range(7)), 1e-6)


def _clocks() -> tuple[float, float]:
    return time.perf_counter(), time.process_time()


def _since(begun: tuple[float, float]) -> tuple[float, float]:
    """Seconds by the clock and of processor."""
    clock, processor = _clocks()
    return clock - begun[0], processor - begun[1]


def measured(folder: Path) -> Measured | str:
    """What a process of its own took for a folder, or why there is nothing."""
    if not (folder / "matrix.yaml").exists():
        return ABSENT
    command = [sys.executable, "-m", "benchmarks.records", str(folder)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, timeout=LONGEST, check=False)
    except subprocess.TimeoutExpired:
        return f"over {LONGEST:g} s, given up"
    if done.returncode:
        return (done.stderr.strip().splitlines() or ["ended without a word"])[-1]
    return Measured(**json.loads(done.stdout))


def _without(reason: str) -> tuple[str, ...]:
    """The cells of a record of which nothing is known; one that is not there misses no goal."""
    return (*["–"] * (len(HEAD) - 1), reason if reason == ABSENT else f"**{reason}**")


def measure() -> Table:
    """Every set of measured records, one after the other."""
    names = os.environ.get("BENCHMARK_RECORDS", "").split() or list(KNOWN)
    found = {name: measured(DATA / name) for name in names}
    rows = [(name, *(one.row if isinstance(one, Measured) else _without(one))) for name, one in found.items()]
    counted = [one for one in found.values() if one != ABSENT]
    return Table(
        "Records",
        "Measured records as a new user diagnoses them, from the folder to the verdict and with what is proposed "
        "beyond the catalogue: the machine is chosen, fitted and diagnosed, without a limit of time. Seconds by the "
        "clock / of processor; where other work shares the machine the clock also counts that. The ratio is of the "
        "processor time to that of one `lfilter` of second order over the measured samples. Memory of the process at "
        "its peak.",
        ("record", *HEAD),
        rows,
        f"by the clock the verdict in {VERDICT:g} s, proposals in {PROPOSED:g} s, above {LONG:,} samples twice as "
        f"long; {MEMORY / 1e9:g} GB; complete",
        bool(counted) and all(isinstance(one, Measured) and one.in_time for one in counted),
    )  # fmt: skip


if __name__ == "__main__":
    print(json.dumps(asdict(measured_here(Path(sys.argv[1])))))

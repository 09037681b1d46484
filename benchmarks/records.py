"""Measured records from the folder to the verdict, and to what is proposed beyond the catalogue; a process each.

BENCHMARK_RECORDS names the sets to take, all of them where it is not there: the rows of others stay on the page.
`python -m benchmarks.records FOLDER` measures one and prints what it took as JSON.
"""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Collection, Mapping, Sequence
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
PAGE = ROOT / "docs" / "benchmarks.md"
TITLE = "Records"
VERDICT, PROPOSED, MEMORY = 110.0, 220.0, 1e9
"""Goals: s of processor to the verdict, s with proposals, bytes. Why: two cores have this done in 60 and 120 s by the
clock, but for a twelfth that one alone works; other work on the machine counts in the clock, not in the processor."""
LONG = 400_000
"""Samples of all runs above which a record may take twice as long."""
HEAD = ("samples", "verdict", "with proposals", "times `lfilter`", "memory", "model", "named", "standing", "complete",
        "goal")  # fmt: skip
ABSENT = "not there"
TIMED = 0.1
"""s of processor that are timed well: some systems count it in hundredths of a second."""
LONGEST = 600
"""s of processor after which a record is given up."""


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
        soon = self.verdict[1] <= longer * VERDICT and self.whole[1] <= longer * PROPOSED
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
        samples=sum(run.length for run in runs),
        verdict=verdict[0] if verdict else whole,
        whole=whole,
        memory=1024.0 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss,
        lfilter=filtering(runs),
        complete=found.complete,
        model=fit.model,
        named=tuple(found.verdict.effects),
        standing=str(found.verdict.standing).replace("_", "-"),
    )


def filtering(runs: Sequence[Run]) -> float:
    """Processor time (s) of one `lfilter` of second order over what runs measured: the mean of as many as are timed
    well."""
    b, a = scipy.signal.butter(2, 0.1)
    count, taken = 1, 0.0
    while taken < TIMED:
        count *= 2
        begun = time.process_time()
        for _ in range(count):
            for run in runs:
                scipy.signal.lfilter(b, a, run.measured)
        taken = time.process_time() - begun
    return taken / count


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
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False, preexec_fn=_limited)
    if done.returncode == -signal.SIGXCPU:
        return f"over {LONGEST} s of processor, given up"
    if done.returncode:
        return (done.stderr.strip().splitlines() or ["ended without a word"])[-1]
    return Measured(**json.loads(done.stdout))


def _limited() -> None:
    """Let the processor end the process that begins once it has had its time."""
    resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST + 10))


def kept(page: str, names: Collection[str]) -> list[tuple[str, ...]]:
    """The rows of the section on a page but those of some sets."""
    _, _, section = page.partition(f"\n## {TITLE}\n")
    lines = section.partition("\n## ")[0].splitlines()
    rows = [tuple(cell.strip() for cell in line.strip("|").split("|")) for line in lines if line.startswith("| ")]
    return [row for row in rows if row[0] in KNOWN and row[0] not in names and len(row) == 1 + len(HEAD)]


def _without(reason: str) -> tuple[str, ...]:
    """The cells of a record of which nothing is known; one that is not there misses no goal."""
    return (*["–"] * (len(HEAD) - 1), reason if reason == ABSENT else f"**{reason}**")


def measure() -> Table:
    """Every set of measured records, one after the other."""
    names = os.environ.get("BENCHMARK_RECORDS", "").split() or list(KNOWN)
    return table({name: measured(DATA / name) for name in names}, PAGE.read_text(encoding="utf-8"))


def table(found: Mapping[str, Measured | str], page: str) -> Table:
    """What was measured of some sets, and the rows that a page has of others, in the order of the sets."""
    rows = [(name, *(one.row if isinstance(one, Measured) else _without(one))) for name, one in found.items()]
    order = [*KNOWN, *found]
    rows = sorted([*rows, *kept(page, found)], key=lambda row: order.index(row[0]))
    counted = [row for row in rows if row[-1] != ABSENT]
    return Table(
        TITLE,
        "Measured records as a new user diagnoses them, from the folder to the verdict and with what is proposed "
        "beyond the catalogue: the machine is chosen, fitted and diagnosed, without a limit of time. Seconds by the "
        "clock / of processor; where other work shares the machine the clock also counts that, and the same work takes "
        "more of the processor, since threads share its cores. The ratio is of the "
        "processor time to that of one `lfilter` of second order over the measured samples. Memory of the process at "
        "its peak.",
        ("record", *HEAD),
        rows,
        f"the verdict in {VERDICT:g} s of processor, proposals in {PROPOSED:g} s, a minute and two by the clock of two "
        f"cores; above {LONG:,} samples twice as long; {MEMORY / 1e9:g} GB; complete",
        bool(counted) and all(row[-1] == "met" for row in counted),
    )


if __name__ == "__main__":
    print(json.dumps(asdict(measured_here(Path(sys.argv[1])))))

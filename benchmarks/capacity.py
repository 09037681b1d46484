"""`python -m benchmarks.capacity`: docs/capacity.md, reckoned from what `python -m benchmarks cost line` measured."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from benchmarks import figures

PAGE = Path(__file__).parents[1] / "docs" / "capacity.md"
DAY, YEAR = 86_400.0, 365.0  # s, days
BUSY = 0.6  # of a core, a disk or a line: the rest is for hours that are busier than the mean
COPIES = 3  # times that raw bytes travel: to the service, from it to S3, from there to a worker
DISK = 1e13  # bytes of a disk for raw uploads
LINK = 1e9 / 8  # bytes a second of a link, each way
ACTUATORS, LENGTHS = (10, 1_000, 100_000), (2, 30)  # a day; s a run, of 63 runs
Figures = dict[str, float]


@dataclass(frozen=True)
class Need:
    """What so many actuators a day take, on the average."""

    actuators: int
    seconds: int
    workers: float
    service: float
    database: float
    raw: float
    records: float
    traffic: float

    @property
    def bottleneck(self) -> str:
        """What is used most of its share: the one process of a service, a worker of one core, the database, a link."""
        shares = {
            "service": self.service / BUSY,
            "worker": self.workers / BUSY,
            "database": self.database / BUSY,
            "link": self.traffic / LINK / BUSY,
        }
        return max(shares, key=lambda name: shares[name])

    @property
    def fits_one(self) -> bool:
        """Whether one machine of two cores has room for the service and for the work on its queue."""
        return self.workers + self.service + self.database <= 2 * BUSY


def need(actuators: int, seconds: int, known: Figures) -> Need:
    """From the figures of one actuator."""
    of = f"of_63_runs_of_{seconds}_s"
    a_second = actuators / DAY
    raw = known[f"raw_{of}"]
    return Need(
        actuators,
        seconds,
        a_second * known[f"fit_{of}"],
        a_second * known[f"upload_{of}"],
        a_second * known[f"database_{of}"],
        actuators * raw,
        actuators * known["bytes_a_set_sqlite"],
        a_second * raw * COPIES,
    )


REMEDIES = {
    "service": (
        "uploads: a service reads and checks two at once",
        "a service more for each core that they take, on the same PostgreSQL and S3, behind a balancer",
        "measured: the processor time of an upload; that services add up is reckoned",
    ),
    "worker": (
        "fits",
        "a worker of one core more for each core that they take",
        "measured: the processor time of a fit; that workers add up: tests/faults/test_machines.py",
    ),
    "database": (
        "statements to PostgreSQL",
        "a machine of its own for it, with its log on a disk that is quick to sync",
        "measured: its processor time for an actuator",
    ),
    "link": (
        "bytes on the network",
        "10 Gbit/s to S3; workers with a large cache; the raw format of the bench, compressed",
        "reckoned: bytes an actuator times three ways; no network of 1 Gbit/s was measured",
    ),
}
"""For each bottleneck: what it is, what is done about it, and how it is known."""


def page(known: Figures) -> str:
    """The document."""
    needs = [need(actuators, seconds, known) for seconds in LENGTHS for actuators in ACTUATORS]
    lines = [
        HEAD.format(busy=100 * BUSY, copies=COPIES, link=8 * LINK / 1e9),
        f"| {' | '.join(COLUMNS)} |",
        f"|{' --- |' * len(COLUMNS)}",
        *map(_row, needs),
        "",
        "## Each bottleneck and its remedy",
        "",
    ]
    for one in needs:
        what, remedy, known_by = REMEDIES[one.bottleneck]
        small = "one machine of two cores has room for all of it" if one.fits_one else remedy
        lines.append(
            f"* **{one.actuators:,} a day, 63 × {one.seconds} s** — {what} come first; {small} ({known_by}). "
            f"{DISK / 1e12:g} TB of raw uploads are full after {_days(one)} (measured: bytes of an "
            f"upload): {_store(one)}."
        )
    return "\n".join([*lines, "", "## What it is reckoned from", "", *_figures(known), ""])


COLUMNS = (
    "actuators a day", "runs", "workers of one core", "services", "PostgreSQL, cores", "raw a day", "raw a year",
    f"{DISK / 1e12:g} TB are full after", "records a year", "network, mean", "comes first",
)  # fmt: skip
HEAD = """# Capacity

Written by `python -m benchmarks.capacity` from what `python -m benchmarks cost line` measured and keeps in
`benchmarks/figures.json`. Re-run the benchmark for your machine. Design rule: no resource above
{busy:g} % of the time on the average: in brackets, for how much it is. Raw bytes travel {copies} times: to the
service, to S3, to a worker; a link has {link:g} Gbit/s. What comes first is the largest share of one core, or of
one link, that is needed.
"""


def _row(one: Need) -> str:
    cells = (
        f"{one.actuators:,}",
        f"63 × {one.seconds} s",
        _whole(one.workers),
        _whole(one.service),
        _whole(one.database),
        _bytes(one.raw),
        _bytes(one.raw * YEAR),
        _days(one),
        _bytes(one.records * YEAR),
        f"{_round(8e-6 * one.traffic)} Mbit/s",
        REMEDIES[one.bottleneck][0],
    )
    return f"| {' | '.join(cells)} |"


def _whole(cores: float) -> str:
    """So many, with what they are busy of one."""
    count = max(1, math.ceil(cores / BUSY))
    return f"{count} ({100 * cores / count:.2g} %)"


def _round(number: float) -> str:
    return f"{number:,.0f}" if number >= 100 else f"{number:.2g}"


def _days(one: Need) -> str:
    days = DISK / one.raw
    return f"{days:.2g} days" if days < YEAR else f"{days / YEAR:.0f} years"


def _store(one: Need) -> str:
    """What is done about raw uploads."""
    if DISK / one.raw >= YEAR:
        return "a disk and its backup"
    return "S3, and raw uploads kept only as long as somebody fits them again"


def _bytes(count: float) -> str:
    for size, unit in ((1e15, "PB"), (1e12, "TB"), (1e9, "GB")):
        if count >= size:
            return f"{count / size:.3g} {unit}"
    return f"{count / 1e6:.3g} MB"


def _figures(known: Figures) -> list[str]:
    shown = []
    for seconds in LENGTHS:
        of = f"of_63_runs_of_{seconds}_s"
        upload, fit, database = (f"{known[f'{what}_{of}']:.2f} s" for what in ("upload", "fit", "database"))
        raw = _bytes(known[f"raw_{of}"])
        shown.append(
            f"* 63 runs of {seconds} s: of processor time {upload} for the upload, {fit} for the fit and {database} of "
            f"PostgreSQL; {raw} raw as npz."
        )
    return [*shown, f"* A set with its result takes {known['bytes_a_set_sqlite'] / 1e3:.1f} kB outside the blobs."]


if __name__ == "__main__":
    PAGE.write_text(page(figures.known()), encoding="utf-8")

"""`python -m tests.faults.page`: docs/faults.md, from what the long runs counted (tests/faults/counted)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

COUNTED = Path(__file__).with_name("counted")
PAGE = Path(__file__).parents[2] / "docs" / "faults.md"
NOTHING = (
    "lost",
    "uploads_lost",
    "failed",
    "stored_twice",
    "differing",
    "in_force_twice",
    "approved_and_not_in_force",
    "orphaned",
    "wrongly_answered",
)
HEAD = """# Fault tolerance

Written by `python -m tests.faults.page` from what was counted by

    python -m tests.faults --kills 100 --database sqlite --seed 1 --json tests/faults/counted/sqlite-1.json
    python -m tests.faults --kills 100 --database postgresql --seed 1 --json tests/faults/counted/postgresql-1.json

Real processes: the service, and with PostgreSQL two workers; uploads lie in S3 (moto). Three clients upload, fit,
diagnose, approve, cancel and ask twice with the same key, each until it is answered. Meanwhile processes are killed
(`kill -9`) at random moments, and between kills PostgreSQL is stopped for 20 s and started, a worker is frozen for
60 s and continued, S3 refuses for 20 s, the disks of the data folder and of PostgreSQL are full for 20 s, and the
clocks of the processes are an hour ahead, or behind, for 20 s. All draws follow from the seed. At the end
everything that was acknowledged is compared with what is there, and every result with that of the same job before
anything struck, in each field but times and names. Disk-full tests need root; clock-step tests
need a C compiler.
"""
TAIL = """
*Lost* are jobs that were acknowledged and are missing, never end, or were cancelled without a request; *uploads lost*
those that cannot be read any more; *orphaned* the raw uploads that no record names after `servoident tidy`. A job of a
lost worker has to run elsewhere within 15 s.

`tests/faults/test_mixed_load.py` is the short form; `python -m tests --full tests/faults` has kills of a single fit
at twenty moments, frozen workers, and a worker on another machine (a network of its own) whose link is cut for 60 s
in a fit.
"""


def page() -> str:
    """The document."""
    runs = [json.loads(file.read_text(encoding="utf-8")) for file in sorted(COUNTED.glob("*.json"))]
    titles = [f"{run['database']}, seed {run['seed']}" for run in runs]
    rows = [("", *titles), ("---",) * (1 + len(runs)), *((name, *map(str, cells)) for name, cells in _rows(runs))]
    return "\n".join([HEAD, *(f"| {' | '.join(row)} |" for row in rows), TAIL])


def _rows(runs: list[dict[str, Any]]) -> list[tuple[str, list[object]]]:
    found: list[tuple[str, list[object]]] = [
        ("kills", [sum(run["kills"].values()) for run in runs]),
        (
            "of them of workers",
            [sum(n for name, n in run["kills"].items() if "servoident" not in name) for run in runs],
        ),
    ]
    for name in sorted({name for run in runs for name in run["others"]}):
        found.append((name.replace("_", " "), [run["others"].get(name, 0) for run in runs]))
    for name in ("submitted", "ended", "cancelled", "twins", "uploads", "approvals"):
        found.append((name.replace("twins", "the same key twice"), [run[name] for run in runs]))
    for name in NOTHING:
        found.append((f"**{name.replace('_', ' ')}**", [_count(run[name]) for run in runs]))
    moved = [f"{max(run['moved']):.1f} s in {len(run['moved'])}" if run["moved"] else "–" for run in runs]
    found.append(("longest until a lost worker's job ran elsewhere", list(moved)))
    found.append(("minutes", [f"{run['minutes']:.0f}" for run in runs]))
    return found


def _count(found: int | list[Any]) -> int:
    return len(found) if isinstance(found, list) else found


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")

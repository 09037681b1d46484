"""Kills and other faults under a mixed load, counted.

`python -m tests.faults --kills 100 --database sqlite --seed 1 [--json FILE]`; exit status 1 where anything was lost,
stored twice or changed.
"""

from __future__ import annotations

import argparse
import json
import signal
import sys
import tempfile
import time
from pathlib import Path

from tests.faults.load import Load
from tests.faults.reckoning import Reckoning, reckon, undisturbed
from tests.faults.strikes import Strikes
from tests.faults.world import world

CLIENTS = 3


def run(
    folder: Path,
    database: str,
    kills: int,
    seed: int,
    *,
    seconds: float = 20.0,
    between: float = 2.0,
    in_s3: bool = True,
    on_disks: bool = True,
    diagnoses: bool = True,
) -> Reckoning:
    """So many kills, and other faults of so many seconds, under load."""
    with world(folder, database, in_s3=in_s3, on_disks=on_disks) as struck_world:
        matrices, fits, before = undisturbed(struck_world, diagnoses)
        loads = [
            Load(struck_world.address, 1000 * seed + number, matrices, fits, diagnoses) for number in range(CLIENTS)
        ]
        for load in loads:
            load.thread.start()
        struck = Strikes(struck_world, seed, seconds, between).run(kills)
        for load in loads:
            load.stopping.set()
        for load in loads:
            load.thread.join()
        return reckon(struck_world, loads, before, struck)


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.faults", description=__doc__)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--database", choices=("sqlite", "postgresql"), default="sqlite")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json", type=Path)
    parser.add_argument("--keep", type=Path, help="folder for data and logs, which are kept")
    given = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # what runs is ended, and its disks are taken away
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as temporary:
        folder = given.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        found = run(folder, given.database, given.kills, given.seed)
    counted = found.to_json() | {
        "seed": given.seed,
        "database": given.database,
        "minutes": (time.monotonic() - began) / 60,
    }
    for name, value in counted.items():
        print(f"{name.replace('_', ' ')}: {value}")
    if given.json:
        given.json.write_text(json.dumps(counted, indent=2) + "\n", encoding="utf-8")
    return 0 if found.holds else 1


if __name__ == "__main__":
    sys.exit(main())

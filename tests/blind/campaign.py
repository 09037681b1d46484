"""The campaign of blind trials: resumable, in parts, its rows kept in docs/blind-trials.jsonl.

python -m tests.blind.campaign one --noise 0.01 --level 3 --seeds 1 2   [--small] [--effects NAME …]
python -m tests.blind.campaign none|two|three|clutter --seeds 1 2 3   [--small]
python -m tests.blind.campaign noise --seeds 2 4 6   [--small] [--effects white autoregressive …]
python -m tests.blind.campaign outside|own|label --seeds 1 2 3
options: --minutes N (stop after), --out FILE
"""

from __future__ import annotations

import argparse
import json
import time
from functools import partial
from pathlib import Path
from typing import Any

from tests.blind.clutter import clutter
from tests.blind.noises import NOISES
from tests.blind.trial import NAMES, label, noisy, outside, own, several, single
from tests.blind.written import WRITTEN
from tests.reference.outside_reference import UNLISTED

NAMED = {
    "one": NAMES,
    "outside": UNLISTED,
    "own": WRITTEN,
    "label": ("mass", "stiffness", "gain"),
    "noise": tuple(NOISES),
}
"""What the trials of a kind are about, by name: what is hidden, but for noise; the other kinds draw it."""
SMALL = ("one", "none", "two", "three", "clutter", "noise")
OUT = Path(__file__).parents[2] / "docs" / "blind-trials.jsonl"


def key(row: dict[str, Any]) -> tuple[Any, ...]:
    """What a trial is told from others by."""
    name = row.get("of") or (next(iter(row["hidden"]), "") if row["kind"] in NAMED else "")
    return row["kind"], row["matrix"], row["noise"], row.get("level"), row["seed"], name


def rows(path: Path = OUT) -> list[dict[str, Any]]:
    """All rows so far; one that says why it is `void` tells of a trial that does not count any more."""
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def add(row: dict[str, Any], path: Path) -> None:
    """Keep a row; lines are short enough to be written whole."""
    with path.open("a") as file:
        file.write(json.dumps(row) + "\n")


def show(row: dict[str, Any]) -> None:
    """One line for who watches."""
    hidden = " ".join(f"{name}={value:.3g}" for name, value in row["hidden"].items()) or "nothing"
    if not row.get("reachable", True):
        print(f"{hidden}: unreachable, {row['linear_error']:.4f} at most", flush=True)
        return
    mark = "hit " if row["named"] else "MISS"
    found = " ".join(row["found"]) or "nothing"
    extra = f" groups {row['groups']}" if row["groups"] else ""
    extra += f" suspects {row['suspects']}" if row["suspects"] else ""
    extra += " unexplained" if row["unexplained"] else ""
    print(
        f"{mark} {hidden} → {found} first {row['first'][0]} verify {row['verify']:.3f} {row['seconds']} s{extra}",
        flush=True,
    )


def main() -> None:
    """Run what is asked for and is not there yet."""
    parser = argparse.ArgumentParser()
    parser.add_argument("kind", choices=(*NAMED, "none", "two", "three", "clutter"))
    parser.add_argument("--noise", type=float, default=0.01)
    parser.add_argument("--level", type=float, default=3.0)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1])
    parser.add_argument("--effects", nargs="+")
    parser.add_argument("--small", action="store_true")
    parser.add_argument("--minutes", type=float, default=1e9)
    parser.add_argument("--out", type=Path, default=OUT)
    asked = parser.parse_args()
    done = {key(row) for row in rows(asked.out)}
    end = time.monotonic() + 60 * asked.minutes
    for seed in asked.seeds:
        for name in asked.effects or NAMED.get(asked.kind, ("",)):
            small = asked.small and asked.kind in SMALL
            matrix = "small" if small else "full"
            level = asked.level if asked.kind == "one" else None
            if (asked.kind, matrix, asked.noise, level, seed, name) in done or time.monotonic() > end:
                continue
            if asked.kind == "one":
                row = single(name, asked.level, asked.noise, asked.small, seed)
            elif asked.kind in NAMED:
                of = {"outside": outside, "own": own, "label": label, "noise": partial(noisy, small=small)}
                row = of[asked.kind](name, seed, asked.noise)
            elif asked.kind == "clutter":
                row = clutter(seed, asked.noise, asked.small)
            else:
                row = several({"none": 0, "two": 2, "three": 3}[asked.kind], seed, asked.noise, asked.small)
            add(row, asked.out)
            show(row)


if __name__ == "__main__":
    main()

"""Fresh trials of every kind, one of each in turn, so that all kinds grow alike.

python -m tests.blind.fresh 140001 140100   [--out FILE] [--kinds NAME …] [--minutes N]

tries the seeds 140001 to 140100 of each kind and keeps one line of JSON a trial, with the seed, what is true, what was
said, how probable it was said to be, and the commit of the program; what is there already is not tried again. A kind
that takes long has its turn once in several seeds. A program that fails has answered wrongly; its row has the error.
"""

from __future__ import annotations

import argparse
import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tests.blind import any_trial, clutter, left_out, periodic_trial, trial, unlisted
from tests.blind.campaign import add, rows
from tests.blind.fresh_table import FRESH, counts, fresh
from tests.blind.machines import OFFSET
from tests.blind.noises import NOISES
from tests.reference.unlisted_reference import NAMES as UNLISTED

LEVELS, SHARES = (1.5, 3.0, 10.0), (0.002, 0.01, 0.05)  # floors that one effect leaves; noise over the output
LABELS = ("mass", "stiffness", "gain")
Row = dict[str, Any]


def _drawn(seed: int, number: int) -> np.random.Generator:
    return np.random.default_rng([seed, 8000 + number])


def one(seed: int) -> Row:
    """One effect at a level and noise that its bounds allow, all drawn."""
    rng = _drawn(seed, 0)
    while True:
        name, level, share = str(rng.choice(trial.NAMES)), float(rng.choice(LEVELS)), float(rng.choice(SHARES))
        row = trial.single(name, level, share, True, seed)
        if row["reachable"]:
            return row


def some_unlisted(seed: int) -> Row:
    """An effect that no list holds: whether the equation that is proposed passes, and is of its class."""
    rng = _drawn(seed, 1)
    while True:
        row = unlisted.trial(str(rng.choice(UNLISTED)), seed, float(rng.choice([3.0, 10.0])))
        if row["reachable"]:
            return row | {"right": bool(row["accepted"] and row["right"]), "of": row["kind"]}


def left_out_one(seed: int) -> Row:
    """An effect of the catalogue that the program does not have: whether an equation of the same class comes back."""
    rng = _drawn(seed, 2)
    while True:
        name = str(rng.choice([name for name in trial.NAMES if name not in OFFSET]))
        row = left_out.trial(name, seed, 3.0)
        if row["reachable"] and row["told"]:
            return row | {"right": bool(row["equivalent"])}


def label(seed: int) -> Row:
    """A wrong label on one run of the full matrix."""
    return trial.label(LABELS[seed % len(LABELS)], seed)


def noise(seed: int) -> Row:
    """Noise of some kind and nothing hidden: neither a name nor a proposal is right."""
    row = trial.noisy(tuple(NOISES)[seed % len(NOISES)], 2 * seed)
    return row | {"right": not row["found"] and not row["proposed"]}


def with_clutter(seed: int) -> Row:
    """One strong effect among weak ones."""
    row = clutter.clutter(seed, small=True)
    return row | {"right": bool(row["named"] and row["clean"])}


def machine(seed: int, hidden: bool) -> Row:
    """A machine of any structure; right where the structure is, and what is hidden or that nothing is."""
    row = any_trial.trial(seed, hidden).row()
    structure = bool(row["right"])
    named = bool(row["named"]) if hidden else row["standing"] != "found"
    return row | {"structure_right": structure, "right": named and (structure or not hidden), "of": row["kind"]}


@dataclass(frozen=True)
class Kind:
    """How a trial of a kind is made, and in how many seeds it has its turn once."""

    make: Callable[[int], Row]
    every: int = 1


KINDS: dict[str, Kind] = {
    "one": Kind(one),
    "two": Kind(lambda seed: trial.several(2, seed, small=True)),
    "three": Kind(lambda seed: trial.several(3, seed, small=True)),
    "none": Kind(lambda seed: trial.several(0, seed, small=True)),
    "machine": Kind(lambda seed: machine(seed, True)),
    "machine, nothing hidden": Kind(lambda seed: machine(seed, False)),
    "periodic": Kind(lambda seed: periodic_trial.trial(seed, True)),
    "periodic, nothing hidden": Kind(lambda seed: periodic_trial.trial(seed, False)),
    "noise": Kind(noise),
    "unlisted": Kind(some_unlisted),
    "label": Kind(label, 2),
    "left out": Kind(left_out_one, 4),
    "clutter": Kind(with_clutter, 4),
}


def tried(name: str, seed: int, commit: str) -> Row:
    """The row of a trial; one that fails has the error."""
    begun = time.process_time()
    try:
        row = KINDS[name].make(seed)
    except Exception as error:  # the campaign goes on, whatever the program does
        row = {"right": False, "failed": f"{type(error).__name__}: {error}"}
    row["right"] = row.get("right", row.get("named"))
    return row | {"trial": name, "seed": seed, "commit": commit, "seconds": round(time.process_time() - begun, 1)}


def main() -> None:
    """Run what is asked for and is not there yet, and sum up."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int)
    parser.add_argument("--out", type=Path, default=FRESH)
    parser.add_argument("--kinds", nargs="+", choices=tuple(KINDS), default=tuple(KINDS))
    parser.add_argument("--minutes", type=float, default=1e9)
    asked = parser.parse_args()
    commit = subprocess.run(["git", "rev-parse", "--short=8", "HEAD"], capture_output=True, text=True, check=True)
    done, end = {(row["trial"], row["seed"]) for row in rows(asked.out)}, time.monotonic() + 60 * asked.minutes
    for seed in range(asked.first, asked.last + 1):
        for name in asked.kinds:
            if seed % KINDS[name].every or (name, seed) in done or time.monotonic() > end:
                continue
            row = tried(name, seed, commit.stdout.strip())
            add(row, asked.out)
            mark = "right" if row["right"] else "WRONG" if counts(row) else "drops"
            said = row.get("failed") or row.get("found", row.get("effects", row.get("named")))
            print(f"{mark} {seed} {name}: {row.get('hidden')} → {said}, {row['seconds']} s", flush=True)
    print("\n".join(fresh(rows(asked.out))))


if __name__ == "__main__":
    main()

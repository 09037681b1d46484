"""Blind trials of the search for missing terms: each effect of the catalogue left out of it in turn.

python -m tests.blind.left_out 1 1 --out FILE   [--effects NAME …] [--level 3] [--minutes N]

hides an effect in the data of the reference and diagnoses with a catalogue that does not hold it: does an equation
come back that does the same? A trial counts where the effect itself reaches the noise and the rest of the catalogue
does not: else the data do not tell it from the others.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from ident.diagnosis import candidate_models
from ident.effects import effect
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.workflows import identify
from tests.blind.campaign import add, rows
from tests.blind.machines import OFFSET, Machine, drawn_plant, drawn_shapes, matrix_of, strength_for
from tests.blind.trial import NAMES
from tests.blind.unlisted import outcome
from tests.blind.unlisted_effects import MODEL
from tests.reference import nonlinear_reference as reference
from tests.reference import qian_reference as linear

_REACHED, _POSSIBLE = 0.85, 1.05  # of the wanted error; floors that the effect itself may leave
_NOISE = 0.01

Row = dict[str, Any]


@dataclass(frozen=True)
class Secret:
    """A machine with a hidden effect, as the trials of what no list holds look at one."""

    machine: Machine

    @property
    def noise(self) -> float:
        """Its share of each run's output."""
        return self.machine.noise

    @property
    def trials(self) -> list[linear.Trial]:
        """The runs of its matrix."""
        return self.machine.trials

    def measured(self, trials: Sequence[linear.Trial] | None = None, noise: float | None = None) -> Matrix:
        """Its test matrix, or other runs, from the reference."""
        of = self.machine
        strengths = {f"{name}.{effect(name).strength.symbol}": value for name, value in of.hidden.items()}
        records = reference.measure_all(
            reference.named({**of.shapes, **strengths}),
            of.trials if trials is None else trials,
            seconds=2.0,
            noise=of.noise if noise is None else noise,
            seed=of.seed,
            plant=of.plant,
        )
        return matrix_of(records, of.plant)


def trial(name: str, seed: int, level: float) -> Row:
    """What the search makes of an effect that was taken out of the catalogue."""
    rng = np.random.default_rng([seed, 7000 + NAMES.index(name), round(10 * level)])
    machine = Machine(drawn_plant(rng), {}, _NOISE, True, int(rng.integers(1 << 30)), drawn_shapes(rng, name))
    strength, reached = strength_for(machine, name, level)
    secret = Secret(replace(machine, hidden={name: strength}))
    row: Row = {"effect": name, "seed": seed, "level": level, "hidden": strength, "linear": reached / _NOISE}
    row["oracle"] = _oracle(secret, name) if reached >= _REACHED * level * _NOISE else None
    row["reachable"] = row["oracle"] is not None and row["oracle"] <= _POSSIBLE
    if not row["reachable"]:
        return row
    with without(name):
        found = outcome(secret, catalogue=True)
    return row | found | {"told": found["listed"] > _POSSIBLE, "equivalent": found["accepted"] and found["right"]}


def _oracle(secret: Secret, name: str) -> float:
    """The error of the refitted model with the effect itself, in floors."""
    fit = identify(secret.measured(), Settings(model=MODEL, effects=(name,)))
    return float(fit.error["fit"] or 0.0) / _NOISE


@contextmanager
def without(name: str) -> Iterator[None]:
    """Until the block ends no diagnosis knows the effect of that name."""
    every = candidate_models.CATALOGUE
    candidate_models.CATALOGUE = tuple(one for one in every if one.name != name)  # type: ignore[misc]
    try:
        yield
    finally:
        candidate_models.CATALOGUE = every  # type: ignore[misc]


def show(row: Row) -> None:
    """One line for who watches."""
    head = f"{row['effect']} seed {row['seed']}"
    if not row["reachable"]:
        print(f"{head}: unreachable, linear error {row['linear']:.2f}, itself {row['oracle']}", flush=True)
        return
    mark = "equivalent" if row["equivalent"] else "MISS" if row["told"] else "the rest of the catalogue does as well"
    print(
        f"{head}: {mark}; {' '.join(row['named']) or '-'}; {' | '.join(row['found']) or 'nothing'}; "
        f"listed {row['listed']:.2f}, verify {row['verify']:.2f}, off {row['off']:.2f} {row['off_new']:.2f}, "
        f"{row['seconds']} s",
        flush=True,
    )


def summary(found: Sequence[Row]) -> str:
    """How many came back of those that the data tell from the rest of the catalogue."""
    told = [row for row in found if row["reachable"] and row["told"]]
    alike = sum(row["reachable"] and not row["told"] for row in found)
    back = sum(row["equivalent"] for row in told)
    return f"{back} of {len(told)} came back as an equation that does the same; of {alike} others do as well"


def main() -> None:
    """Run what is asked for and is not there yet, and sum up."""
    parser = argparse.ArgumentParser()
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--effects", nargs="+", choices=NAMES, default=[name for name in NAMES if name not in OFFSET])
    parser.add_argument("--level", type=float, default=3.0)
    parser.add_argument("--minutes", type=float, default=1e9)
    asked = parser.parse_args()
    done = {(row["effect"], row["seed"], row["level"]) for row in rows(asked.out)}
    end = time.monotonic() + 60 * asked.minutes
    for seed, name in product(range(asked.first, asked.last + 1), asked.effects):
        if (name, seed, asked.level) not in done and time.monotonic() < end:
            row = trial(name, seed, asked.level)
            add(row, asked.out)
            show(row)
    print(summary(rows(asked.out)))


if __name__ == "__main__":
    main()

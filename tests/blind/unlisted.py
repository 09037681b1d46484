"""Blind trials of the search for missing terms: 24 effects of eight kinds that no list holds.

python -m tests.blind.unlisted 1 3 --out FILE   [--effects NAME …] [--levels 3 10] [--full] [--catalogue] [--minutes N]

tries the seeds 1 to 3 and keeps one line of JSON a trial; what is there already is not tried again. The search begins
beside the linear fit, with `--catalogue` the whole diagnosis goes before.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterable, Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from ident.comparison.compare import modelled
from ident.custom.definition import preset_with
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.result import Diagnosis
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.preprocessing import prepare
from ident.workflows import diagnose, identify
from tests.blind import characteristic
from tests.blind.campaign import add, rows
from tests.blind.machines import runs_away
from tests.blind.sure import sure
from tests.blind.unlisted_effects import KIND, MODEL, secret, written
from tests.reference import qian_reference as linear
from tests.reference.unlisted_reference import KINDS, NAMES

TERMS, SHAPES, VERIFY = 3, 2, 1.2  # of a proposal that is accepted, at most: terms, shapes of all, floors
LAW = 0.05  # of the flow, or force: how far the characteristic may be off
RIGHT, RIGHT_NEW = 0.3, 0.5  # of the noise: how far from the truth the outputs of the right class are, at most
_LEAST = 0.85  # of the wanted error: below it the cell is unreachable
_POSSIBLE = 1.05  # floors that the true equation itself may leave
_NEW = [linear.Trial(linear.Cell(1.3, 20e3, 0.0, gain), 1.5 * rms) for gain in (5.0, 8.0) for rms in linear.AMPLITUDES]

Row = dict[str, Any]


def trial(name: str, seed: int, level: float, full: bool = False, catalogue: bool = False) -> Row:
    """What the search makes of one hidden effect."""
    machine, error = secret(name, seed, level, full)
    row: Row = {
        "kind": KIND[name],
        "effect": name,
        "seed": seed,
        "level": level,
        "matrix": "full" if full else "small",
        "catalogue": catalogue,
        "hidden": machine.hidden[1:],
        "noise": machine.noise,
        "linear": error,
    }
    oracle = machine.oracle() if error >= _LEAST * level else None
    row["oracle"] = (oracle.error["fit"] or 0.0) / machine.noise if oracle else None
    row["reachable"] = row["oracle"] is not None and row["oracle"] <= _POSSIBLE
    if oracle is None or not row["reachable"]:
        return row
    return row | outcome(machine, catalogue, (written(machine.hidden), oracle.values))


class Hiding(Protocol):
    """A machine with something hidden; `noise` is its share of each run's output."""

    @property
    def noise(self) -> float: ...

    @property
    def trials(self) -> list[linear.Trial]: ...

    def measured(self, trials: Sequence[linear.Trial] | None = None, noise: float | None = None) -> Matrix:
        """Its test matrix, or other runs."""


def outcome(machine: Hiding, catalogue: bool, true: tuple[Mapping[str, Any], Mapping[str, float]] | None = None) -> Row:
    """The proposals beside the linear model, or beside what the catalogue found, against the truth.

    Where the equation that is `true` is given, with the values of its refit, so is how far the characteristic is off.
    """
    matrix = machine.measured()
    fit = identify(matrix, Settings(model=MODEL))
    begun = time.perf_counter()
    found = diagnose(matrix, fit, most=CRITERIA.selection.usual if catalogue else 0, propose=True)
    seconds = round(time.perf_counter() - begun, 1)
    proposed, listed = found.proposals or (), found.ladder[-1]
    errors = {use: ((proposed or [listed])[-1].error[use] or 0.0) / machine.noise for use in ("fit", "verify")}
    shapes = [one.shapes for one in proposed]
    accepted = bool(proposed) and len(proposed) <= TERMS and sum(shapes) <= SHAPES and errors["verify"] <= VERIFY
    new = [t for t in _NEW if not runs_away(machine.measured([t], 0.0))] or machine.trials  # within the stroke
    off = [_off(found, machine.measured(trials, 0.0), machine.noise) for trials in (machine.trials, new)]
    return {
        "named": list(found.verdict.effects),
        "listed": (listed.error["verify"] or 0.0) / machine.noise,
        "found": [one.equation for one in proposed],
        "shapes": shapes,
        **errors,
        "accepted": accepted,
        "off": off[0],
        "off_new": off[1],
        "right": off[0] <= RIGHT and off[1] <= RIGHT_NEW,
        "notes": list(found.notes),
        "seconds": seconds,
        **sure(found),
    } | ({"law_off": characteristic.off(matrix, MODEL, true, found)} if true else {})


def _off(found: Diagnosis, clean: Matrix, noise: float) -> float:
    """How far the model's outputs are from those without noise, in deviations of the noise, on average over runs."""
    effects, custom, known = characteristic.ending(found)
    model, driven = prepare(preset_with(MODEL, effects, custom), clean)
    values = {p.in_equations: known.get(p.name, p.value) for p in model.parameters}
    outputs = modelled(model, values, driven)
    left = [np.std(run.measured - outputs[run.id]) / np.std(run.measured) for run in clean.runs]
    return float(np.mean(left)) / noise


def show(row: Row) -> None:
    """One line for who watches."""
    head = f"{row['effect']} seed {row['seed']} level {row['level']:g}"
    if not row["reachable"]:
        print(f"{head}: unreachable, linear error {row['linear']:.2f}, true equation {row['oracle']}", flush=True)
        return
    mark = " ".join(word for word in ("accepted", "right") if row[word]) or "MISS"
    print(
        f"{head}: {mark}; {' | '.join(row['found']) or 'nothing'}; verify {row['verify']:.2f}, "
        f"off {row['off']:.2f} {row['off_new']:.2f}, law {100 * row['law_off']:.2g} %, {row['seconds']} s",
        flush=True,
    )


def table(found: Sequence[Row]) -> Iterable[str]:
    """What came out, by kind."""
    yield "| kind | trials | accepted | right class | both | law within 5 % | catalogue alone at the floor | seconds |"
    yield "|---|---|---|---|---|---|---|---|"
    tried = [row for row in found if row["reachable"]]
    for kind in (*KINDS, "all"):
        rows_of = [row for row in tried if kind in (row["kind"], "all")]
        if rows_of:
            counts = [sum(row[word] for row in rows_of) for word in ("accepted", "right")]
            both = sum(row["accepted"] and row["right"] for row in rows_of)
            law = sum(row["accepted"] and row.get("law_off", np.inf) <= LAW for row in rows_of)
            alone = sum(row["catalogue"] and row["listed"] <= _POSSIBLE for row in rows_of)
            seconds = np.median([row["seconds"] for row in rows_of])
            yield f"| {kind} | {len(rows_of)} | {counts[0]} | {counts[1]} | {both} | {law} | {alone} | {seconds:.0f} |"


def key(row: Row) -> tuple[Any, ...]:
    """What a trial is told from others by."""
    return tuple(row[name] for name in ("effect", "seed", "level", "matrix", "catalogue"))


def main() -> None:
    """Run what is asked for and is not there yet, and sum up."""
    parser = argparse.ArgumentParser()
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--effects", nargs="+", choices=NAMES, default=NAMES)
    parser.add_argument("--levels", type=float, nargs="+", default=[3.0, 10.0])
    parser.add_argument("--full", action="store_true")
    parser.add_argument("--catalogue", action="store_true")
    parser.add_argument("--minutes", type=float, default=1e9)
    asked = parser.parse_args()
    done, end = {key(row) for row in rows(asked.out)}, time.monotonic() + 60 * asked.minutes
    for seed, level, name in product(range(asked.first, asked.last + 1), asked.levels, asked.effects):
        cell = (name, seed, level, "full" if asked.full else "small", asked.catalogue)
        if cell not in done and time.monotonic() < end:
            row = trial(name, seed, level, asked.full, asked.catalogue)
            add(row, asked.out)
            show(row)
    print("\n".join(table(rows(asked.out))))


if __name__ == "__main__":
    main()

"""Periodic tests, diagnosed: is what is named among what the test allows, and nothing named where nothing is hidden?

python -m tests.blind.periodic_trial hidden|nothing 1 400   [--out FILE] [--minutes N] [--seconds N] [--dry]

tries the seeds 1 to 400 and keeps one line of JSON a trial; what is there already is not tried again. What counts is
decided before the program runs (tests/blind/periodic_class.py) and is kept with the row; a test that was dropped is a
row too. With `--dry` the program does not run at all: what is drawn, what counts.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Collection, Iterable, Sequence
from pathlib import Path
from typing import Any

from ident.diagnosis.result import Diagnosis
from ident.errors import Unusable
from ident.fit.settings import Settings
from ident.workflows import diagnose, identify
from tests.blind.campaign import add, rows
from tests.blind.periodic import MODELS, Test
from tests.blind.periodic_class import Allowed, allowed
from tests.blind.periodic_drawn import completed
from tests.blind.sure import sure
from tests.blind.table import PERIODIC, periodic

_FLOOR = 1.05  # floors that a refit leaves, and is at the floor
_OTHER = 2.0  # times the true shape, or its inverse: the shape of a refit that did not find it
_NAMES = {
    "end_stop": "stiffness",
    "presliding_friction": "displacement",
    "stribeck_friction": "speed",
    "specimen_hysteresis": "yield_displacement",
}
_SHAPES = {"presliding_friction": "xs", "stribeck_friction": "vs", "specimen_hysteresis": "xy"}

Row = dict[str, Any]


def right(
    named: Sequence[str], groups: Iterable[Collection[str]], hidden: str, class_: Collection[str], counts: str
) -> bool:
    """Whether a verdict is right: every name in the class, or in a group that lies in it and holds the truth."""
    if counts == "nothing":
        return not named
    granted = [group for group in groups if hidden in group and set(group) <= set(class_)]
    return bool(named) and all(name in class_ or any(name in group for group in granted) for name in named)


def described(test: Test, decided: Allowed) -> Row:
    """What is kept of a test and of what it allows."""
    d2 = {name or "base": float(f"{left:.4g}") for name, left in decided.d2.items()}
    return {
        "seed": test.seed, "machine": test.machine, "wave": test.wave.kind, "samples": round(test.samples, 2),
        "periods": test.periods, "length": test.length, "given": test.given if test.machine == "specimen" else "",
        "begins": test.begins, "noise": round(test.noise, 5), "hidden": test.hidden, "shapes": test.shapes,
        "base": round(decided.error, 3), "class": list(decided.names), "counts": decided.counts, "d2": d2,
    }  # fmt: skip


def trial(seed: int, hidden: bool, seconds: float | None = None, dry: bool = False) -> Row:
    """One test: what it allows, and what the program says of it."""
    begun = time.process_time()
    test = completed(seed, hidden)
    decided = allowed(test)
    row = {"kind": "hidden" if hidden else "nothing"} | described(test, decided)
    row["reference_seconds"] = round(time.process_time() - begun, 1)
    if row["counts"] == "dropped" or dry:
        return row
    begun = time.process_time()
    try:
        matrix = test.measured()
        fit = identify(matrix, Settings(model=MODELS[test.machine]))
        found = diagnose(matrix, fit, seconds=seconds, propose=False)
    except Unusable as refused:
        return row | {"right": False, "why": f"refused: {refused}", "named": []}
    return row | said(test, decided, found) | {"seconds": round(time.process_time() - begun, 1)}


def said(test: Test, decided: Allowed, found: Diagnosis) -> Row:
    """The verdict, judged, and what the refits came to, in floors of the noise."""
    named, groups = found.verdict.effects, found.verdict.indistinguishable
    floors = {
        one.effect: round((one.error.get("fit") or 0.0) / test.noise, 3)
        for one in found.candidates
        if one.error.get("fit") is not None
    }
    row: Row = {
        "named": list(named),
        "groups": [list(group) for group in groups],
        "standing": found.verdict.standing,
        "unexplained": found.verdict.unexplained,
        "complete": found.complete,
        "candidates": floors,
        "errors": {use: round((found.ladder[-1].error.get(use) or 0.0) / test.noise, 3) for use in ("fit", "verify")},
        "floor": round((found.noise_floor["fit"] or 0.0) / test.noise, 3),
        "linear": round((found.ladder[0].error.get("fit") or 0.0) / test.noise, 3),
        "right": right(named, groups, test.hidden, decided.names, decided.counts),
        **sure(found),
    }
    return row | {"why": "" if row["right"] else why(test, decided, found, row)}


def why(test: Test, decided: Allowed, found: Diagnosis, row: Row) -> str:
    """In a word or two what went wrong, as far as the refits tell."""
    if decided.counts == "nothing":
        at_base = row["linear"] <= _FLOOR
        return "named where nothing is hidden" + (
            "" if at_base else f": the base's own fit ends at {row['linear']:.2f}"
        )
    words = []
    extra = [name for name in row["named"] if name not in decided.names]
    if any(name in decided.names for name in row["named"]):
        words.append("needless companion " + ", ".join(extra))
    ours = [one for one in found.candidates if one.effect in decided.names]
    refits = {one.effect: row["candidates"].get(one.effect) for one in ours}
    if row["linear"] > 1.05 * decided.error:
        words.append(f"base not converged ({row['linear']:.2f} for {decided.error:.2f} floors)")
    if not any(refits.values()):
        words.append("none of the class was refitted")
    elif min(left for left in refits.values() if left) > _FLOOR:
        words += [_stopped(test, one.effect, one.parameters, left) for one in ours if (left := refits[one.effect])]
    elif not extra:
        words.append("refit at the floor, not named")
    else:
        words.append("refit at the floor, another preferred")
    return "; ".join(words)


def _stopped(test: Test, name: str, parameters: Any, left: float) -> str:
    """How far the refit of an effect of the class came, and whether its shape is the true one."""
    text = f"{name} refit ends at {left:.2f} floors"
    if name == test.hidden and name in _SHAPES:
        true = getattr(test.law, f"{name}_{_SHAPES[name]}")
        shape = parameters.get(f"{name}.{_NAMES[name]}")
        value = shape.value if shape else None
        if value is None:
            return f"{text}, shape held"
        if not 1 / _OTHER < value / true < _OTHER:
            return f"{text}, shape {value:.3g} for {true:.3g}"
    return f"{text}, not converged"


def show(row: Row) -> None:
    """One line for who watches."""
    head = (
        f"{row['seed']} {row['machine']} {row['wave']} {row['samples']:.4g}/{row['periods']} noise "
        f"{100 * row['noise']:.2g} % {row['given']} {row['begins']}: {row['hidden'] or 'nothing'} "
        f"({row['counts']}, base {row['base']:.2f}, class {' '.join(row['class']) or '-'})"
    )
    if "right" not in row:
        print(head, flush=True)
        return
    mark = "right" if row["right"] else "WRONG"
    print(f"{mark} {head} → {' '.join(row['named']) or 'nothing'} {row.get('errors', '')} {row['why']}", flush=True)


def main() -> None:
    """Run what is asked for and is not there yet, and sum up."""
    parser = argparse.ArgumentParser()
    parser.add_argument("kind", choices=("hidden", "nothing"))
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int)
    parser.add_argument("--out", type=Path, default=PERIODIC)
    parser.add_argument("--minutes", type=float, default=1e9)
    parser.add_argument("--seconds", type=float, help="that a diagnosis may take; without it as long as it needs")
    parser.add_argument("--dry", action="store_true")
    asked = parser.parse_args()
    done = {(row["kind"], row["seed"]) for row in rows(asked.out)}
    end = time.monotonic() + 60 * asked.minutes
    for seed in range(asked.first, asked.last + 1):
        if (asked.kind, seed) not in done and time.monotonic() < end:
            row = trial(seed, asked.kind == "hidden", asked.seconds, asked.dry)
            add(row, asked.out)
            show(row)
    print("\n".join(periodic(rows(asked.out))))


if __name__ == "__main__":
    main()

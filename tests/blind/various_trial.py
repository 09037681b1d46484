"""Trials of machines of many kinds: the structure, what is hidden, an input that is missing, an oscillation.

python -m tests.blind.various_trial 168001 168300   [--out FILE] [--minutes N] [--dry]
python -m tests.blind.various_trial 168001 168200 --checks

Of fifteen seeds two lack an input, two oscillate by themselves, and three have nothing hidden. What the records show is
decided before the program runs: `shown` in a row. With `--checks` no model is fitted: each seed has a record that lacks
an input and one that does not, one that oscillates and one that does not, and what `check` says is counted.
"""

from __future__ import annotations

import argparse
import subprocess
import time
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from ident.checks.missing_input import missing_inputs
from ident.checks.self_oscillation import self_oscillation
from ident.diagnosis.result import Diagnosis
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.workflows import diagnose, identify
from tests.blind.campaign import add, rows
from tests.blind.levers import Levers
from tests.blind.loops import FEWEST, Loop
from tests.blind.sure import sure
from tests.blind.various import KINDS, Various, sound
from tests.blind.various_table import ROWS, rates

LEAST_D2, LEAST_FLOORS = 60.0, 1.1  # what is hidden leaves, of the variance of the noise, and of its deviation
SAME = 0.5  # of the noise: so much may another model differ from the machine and be called right
Row = dict[str, Any]


def trial(seed: int, dry: bool = False) -> Row:
    """One machine by its seed."""
    if seed % 15 < 2:
        return _lacking(Levers.drawn(seed, missing=True), dry)
    if seed % 15 < 4:
        return _oscillating(Loop.drawn(seed, stable=False), dry)
    return _hiding(Various.drawn(seed, hidden=seed % 15 > 6), dry)


def _hiding(of: Various, dry: bool) -> Row:
    row: Row = {"kind": of.kind, "hidden": of.hidden, "hold": of.hold, "unknown": of.unknown, "noise": of.noise}
    row |= {"strength": of.strength, "offset": of.offset, "level": of.level}
    row["shown"] = _shown(of) if of.hidden else True
    if dry or not row["shown"]:
        return row
    model, found = _diagnosed(of.measured())
    verdict = found.verdict
    named = {name for group in verdict.indistinguishable if len(group) <= 3 for name in group} | set(verdict.effects)
    return (
        row
        | _said(found)
        | {
            "model": model,
            "structure": model == KINDS[of.kind][3] or _differs(of, model) <= SAME * of.noise,
            "named": of.hidden in named if of.hidden else not verdict.effects,
            "errors": [found.ladder[0].error.get("fit"), found.ladder[-1].error.get("fit")],
        }
    )


def _lacking(of: Levers, dry: bool) -> Row:
    row: Row = {"kind": of.kind, "hidden": "missing input", "of": of.extra, "shown": of.shown}
    if dry or not of.shown:
        return row
    _, found = _diagnosed(Matrix(Actuator("L"), (of.run("fit"), of.run("verify"))))
    return row | _said(found) | {"named": bool(found.missing_inputs) and not found.verdict.effects}


def _oscillating(of: Loop, dry: bool) -> Row:
    row: Row = {
        "kind": of.kind,
        "hidden": "self-oscillation",
        "frequency": of.frequencies[0],
        "shown": of.oscillates,
    }
    if dry or not row["shown"]:
        return row
    _, found = _diagnosed(Matrix(Actuator("O"), (of.run("fit"), of.run("verify"))))
    near = [of.near(float(one["frequency"]), float(one["growth"])) for one in found.oscillation]
    return row | _said(found) | {"named": any(near)}


def _diagnosed(matrix: Matrix) -> tuple[str, Diagnosis]:
    fit = identify(matrix, Settings(model=""))
    return fit.model, diagnose(matrix, fit, propose=False)


def _said(found: Diagnosis) -> Row:
    verdict = found.verdict
    return {
        "effects": list(verdict.effects),
        "groups": [list(group) for group in verdict.indistinguishable],
        "standing": verdict.standing,
        "missing": bool(found.missing_inputs),
        "swings": bool(found.oscillation),
        **sure(found),
    }


def _differs(of: Various, model: str) -> float:
    """The noise-free error of the best fit of a model that is not the machine's own, nothing hidden."""
    return identify(sound(of).measured(noisy=False), Settings(model=model)).error["fit"] or 0.0


def _shown(of: Various) -> bool:
    """Whether what is hidden shows: what the machine without it, refitted by SciPy, leaves of a run it never saw."""
    bare, commands = sound(of), [of.command(np.random.default_rng([169, of.seed, number])) for number in (0, 2)]
    seen, unseen = (of.answered(u) for u in commands)

    def left(p: np.ndarray, u: np.ndarray, y: np.ndarray) -> np.ndarray:
        scaled = replace(bare, quick=of.quick * float(np.exp(p[0])), damping=of.damping * float(np.exp(p[1])))
        off = y - float(np.exp(p[2])) * scaled.answered(u)
        return np.asarray((off - off.mean()) / y.std())

    best = least_squares(left, np.zeros(3), args=(commands[0], seen), diff_step=1e-3, max_nfev=12).x
    d2 = float(np.sum((left(best, commands[1], unseen) / of.noise) ** 2))
    return bool(d2 >= LEAST_D2 and np.sqrt(1.0 + d2 / len(unseen)) >= LEAST_FLOORS)


def checked(seed: int) -> Counter[str]:
    """What `check` says of the four records of a seed."""
    counts: Counter[str] = Counter()
    for lacks in (True, False):
        levers, word = Levers.drawn(seed, missing=lacks), "lacks an input" if lacks else "lacks none"
        if levers.shown or not lacks:
            said = bool(missing_inputs(levers.run("fit")))
            counts += Counter({word: 1, f"{word}, said": said})
            if said != lacks:
                print(f"WRONG {word}: {levers}", flush=True)
    for stable in (False, True):
        loop = Loop.drawn(seed, stable)
        word = "stable" if stable else "oscillates"
        if loop.command == "noise":
            word = "stable under noise" if stable else "lasts under noise"
        if not stable and not loop.oscillates and loop.periods >= FEWEST:
            counts += Counter({"is put out": 1, "is put out, said": self_oscillation(loop.run("fit")) is not None})
        if stable or loop.oscillates:
            found = self_oscillation(loop.run("fit"))
            near = found is not None and loop.near(found.frequency, found.growth)
            counts += Counter({word: 1, f"{word}, said": found is not None})
            counts += Counter({f"{word}, within 2 %": 1}) if near and not stable else Counter()
            if stable != (found is None) or (not stable and not near):
                print(
                    f"WRONG {word}: {loop} {loop.frequencies} Hz, {loop.periods:.0f} periods, said "
                    f"{found and found.frequency}",
                    flush=True,
                )
    return counts


def main() -> None:
    """Run what is asked for and is not there yet, and sum up."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int)
    parser.add_argument("--out", type=Path, default=ROWS)
    parser.add_argument("--minutes", type=float, default=1e9)
    parser.add_argument("--dry", action="store_true")
    parser.add_argument("--checks", action="store_true")
    asked = parser.parse_args()
    seeds = range(asked.first, asked.last + 1)
    commit = subprocess.run(["git", "rev-parse", "--short=8", "HEAD"], capture_output=True, text=True, check=True)
    if asked.checks:
        counts = sum((checked(seed) for seed in seeds), Counter[str]())
        add({"checks": counts, "seeds": [asked.first, asked.last], "commit": commit.stdout.strip()}, asked.out)
        print("\n".join(rates(rows(asked.out))))
        return
    done, end = {row.get("seed") for row in rows(asked.out)}, time.monotonic() + 60 * asked.minutes
    for seed in seeds:
        if seed in done or time.monotonic() > end:
            continue
        begun = time.process_time()
        try:
            row = trial(seed, asked.dry)
        except Exception as error:  # the campaign goes on, whatever the program does
            row = {"shown": True, "named": False, "hidden": "?", "failed": f"{type(error).__name__}: {error}"}
        row |= {"seed": seed, "seconds": round(time.process_time() - begun, 1), "commit": commit.stdout.strip()}
        if not asked.dry:
            add(row, asked.out)
        print({key: value for key, value in row.items() if key not in ("effect_sets", "steps")}, flush=True)
    print("\n".join(rates(rows(asked.out))))


if __name__ == "__main__":
    main()

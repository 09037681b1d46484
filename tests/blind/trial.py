"""One blind trial: a machine with something hidden, the diagnosis of its matrix, and a row of what came out."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from ident.diagnose import diagnose
from ident.diagnosis.result import Diagnosis
from ident.effects import EFFECTS
from ident.fit.identification import identify
from ident.fit.settings import Settings
from ident.matrix import Matrix
from tests.blind.machines import OFFSET, Machine, drawn_plant, offset_strength, strength_for

NAMES = tuple(effect.name for effect in EFFECTS)
_REACHED = 0.85  # of the wanted linear error: below it the cell is called unreachable


def single(name: str, level: float, noise: float, small: bool, seed: int) -> dict[str, Any]:
    """One effect hidden, at `level` times the floor where its bounds allow it."""
    rng = np.random.default_rng([seed, NAMES.index(name), round(10 * level), round(1e4 * noise), small])
    machine = Machine(drawn_plant(rng), {}, noise, small, int(rng.integers(1 << 30)))
    if name in OFFSET:
        strength, reached = offset_strength(machine, name, level), noise
    else:
        strength, reached = strength_for(machine, name, level)
    strength *= -1.0 if rng.random() < 0.5 and EFFECTS[NAMES.index(name)].strength.lower < 0 else 1.0
    row: dict[str, Any] = {
        "kind": "one", "matrix": "small" if small else "full", "noise": noise, "level": level, "seed": seed,
        "hidden": {name: strength}, "linear_error": reached,
        "reachable": name in OFFSET or reached >= _REACHED * level * noise,
    }  # fmt: skip
    if not row["reachable"]:
        return row
    return row | outcome(Machine(machine.plant, {name: strength}, noise, small, machine.seed))


def several(count: int, seed: int, noise: float = 0.01) -> dict[str, Any]:
    """`count` effects hidden, each at least 3 times the floor by itself where its bounds allow it; none for 0."""
    rng = np.random.default_rng([seed, 1000 + count])
    plant, start = drawn_plant(rng), int(rng.integers(1 << 30))
    hidden: dict[str, float] = {}
    while len(hidden) < count:
        name = str(rng.choice([n for n in NAMES if n not in hidden and n not in OFFSET]))
        wanted = float(np.exp(rng.uniform(np.log(3.1), np.log(6.0))))
        strength, reached = strength_for(Machine(plant, {}, noise, False, start), name, wanted)
        if reached >= 2.8 * noise:
            hidden[name] = strength
    kinds = {0: "none", 1: "one", 2: "two", 3: "three"}
    row: dict[str, Any] = {"kind": kinds[count], "matrix": "full", "noise": noise, "seed": seed, "hidden": hidden}
    return row | outcome(Machine(plant, hidden, noise, False, start))


def outcome(machine: Machine) -> dict[str, Any]:
    """What the diagnosis says of a machine."""
    return judged(machine.measured(), machine.hidden)


def judged(matrix: Matrix, hidden: dict[str, float] | Any) -> dict[str, Any]:
    """Fit, diagnose, and compare with the truth."""
    fit = identify(matrix, Settings())
    begun = time.perf_counter()
    found = diagnose(matrix, fit)
    last = found.ladder[-1]
    floor = found.noise_floor
    return {
        "error": fit.error["fit"], "floor": floor["fit"], "found": list(found.verdict.effects),
        "groups": [list(group) for group in found.verdict.indistinguishable],
        "first": [c.effect for c in found.candidates[:3]], "first_group": list(found.candidates[0].group),
        "strengths": {name: _strength(found, name) for name in found.verdict.effects},
        "after": last.error["fit"], "verify": (last.error["verify"] or 0) / (floor["verify"] or 1),
        "unexplained": found.verdict.unexplained, "suspects": [[s.run, s.what] for s in found.verdict.suspects],
        "named": named(found, set(hidden)), "seconds": round(time.perf_counter() - begun, 1),
    }  # fmt: skip


def _strength(found: Diagnosis, name: str) -> float:
    effect = EFFECTS[NAMES.index(name)]
    return found.ladder[-1].parameters[f"{name}.{effect.strength.name}"].value


def named(found: Diagnosis, hidden: set[str]) -> bool:
    """Whether the verdict is the hidden set, each effect itself or in a group of at most 3 with what was named."""
    groups = [set(group) for group in found.verdict.indistinguishable if len(group) <= 3]
    left = set(hidden)
    for name in found.verdict.effects:
        alike = next((group for group in groups if name in group), {name})
        hit = name if name in left else next(iter(sorted(alike & left)), None)
        if hit is None:
            return False
        left.discard(hit)
    return not left

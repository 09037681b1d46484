"""One blind trial: a machine with something hidden, the diagnosis of its matrix, and a row of what came out."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Any

import numpy as np

from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.result import Diagnosis
from ident.effects import EFFECTS
from ident.effects.effect import Effect
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.run import Run, Specimen
from ident.workflows import diagnose, identify
from tests.blind.machines import (
    OFFSET,
    Machine,
    as_fit,
    drawn_plant,
    drawn_shapes,
    matrix_of,
    offset_strength,
    strength_for,
)
from tests.blind.noises import NOISES, with_noise
from tests.blind.sure import sure
from tests.blind.written import written
from tests.reference import qian_reference as linear
from tests.reference.outside_reference import Outside, measure_all

NAMES = tuple(effect.name for effect in EFFECTS)
_REACHED = 0.85  # of the wanted linear error: below it the cell is called unreachable


def single(name: str, level: float, noise: float, small: bool, seed: int) -> dict[str, Any]:
    """One effect hidden, at `level` times the floor where its bounds allow it."""
    rng = np.random.default_rng([seed, NAMES.index(name), round(10 * level), round(1e4 * noise), small])
    machine = Machine(drawn_plant(rng), {}, noise, small, int(rng.integers(1 << 30)), drawn_shapes(rng, name))
    sign = -1.0 if rng.random() < 0.5 and EFFECTS[NAMES.index(name)].strength.lower < 0 else 1.0
    if name in OFFSET:
        strength, reached = sign * offset_strength(machine, name, level), noise
    else:
        strength, reached = strength_for(machine, name, level, sign)
    row: dict[str, Any] = {
        "kind": "one",
        "matrix": "small" if small else "full",
        "noise": noise,
        "level": level,
        "seed": seed,
        "hidden": {name: strength},
        "linear_error": reached,
        "reachable": name in OFFSET or reached >= _REACHED * level * noise,
    }
    if not row["reachable"]:
        return row
    shapes = {"shapes": dict(machine.shapes)} if machine.shapes else {}
    return row | shapes | outcome(replace(machine, hidden={name: strength}))


def several(count: int, seed: int, noise: float = 0.01, small: bool = False) -> dict[str, Any]:
    """`count` effects hidden, each at least 3 times the floor by itself where its bounds allow it; none for 0."""
    rng = np.random.default_rng([seed, 1000 + count, *[1] * small])
    plant, start = drawn_plant(rng), int(rng.integers(1 << 30))
    hidden: dict[str, float] = {}
    shapes: dict[str, float] = {}
    while len(hidden) < count:
        name = str(rng.choice([n for n in NAMES if n not in hidden and n not in OFFSET]))
        wanted = float(np.exp(rng.uniform(np.log(3.1), np.log(6.0))))
        drawn = drawn_shapes(rng, name)
        strength, reached = strength_for(Machine(plant, {}, noise, small, start, drawn), name, wanted)
        if reached >= 2.8 * noise:
            hidden[name] = strength
            shapes |= drawn
    kinds = {0: "none", 1: "one", 2: "two", 3: "three"}
    row: dict[str, Any] = {
        "kind": kinds[count],
        "matrix": "small" if small else "full",
        "noise": noise,
        "seed": seed,
        "hidden": hidden,
    }
    return row | ({"shapes": shapes} if shapes else {}) | outcome(Machine(plant, hidden, noise, small, start, shapes))


def outside(kind: str, seed: int, noise: float = 0.01) -> dict[str, Any]:
    """An effect that the catalogue does not hold, at 2.5 to 5 times the floor."""
    matrix, strength = _unlisted(kind, np.random.default_rng([seed, 2000 + Outside._fields.index(kind)]), noise)
    row = {"kind": "outside", "matrix": "full", "noise": noise, "seed": seed, "hidden": {kind: strength}}
    found = judged(matrix, {kind: strength})
    at_floor = found["after"] < 1.02 * found["floor"]
    return row | found | {"named": bool(found["unexplained"] or not found["found"] or at_floor)}


def own(kind: str, seed: int, noise: float = 0.01) -> dict[str, Any]:
    """The same with its equation written down: whether the error then falls to 1.1 times the floor."""
    matrix, strength = _unlisted(kind, np.random.default_rng([seed, 4000 + Outside._fields.index(kind)]), noise)
    row = {"kind": "own", "matrix": "full", "noise": noise, "seed": seed, "hidden": {kind: strength}}
    found = judged(matrix, {kind: strength}, (written(kind),))
    return row | found | {"named": bool(found["named"] and found["after"] <= 1.1 * found["floor"])}


def _unlisted(kind: str, rng: np.random.Generator, noise: float) -> tuple[Matrix, float]:
    plant, start = drawn_plant(rng), int(rng.integers(1 << 30))
    goal = noise * float(np.sqrt(np.exp(rng.uniform(np.log(2.5), np.log(5.0))) ** 2 - 1))
    strength, trials = 0.1, linear.trials()
    for _ in range(6):
        records = measure_all(Outside(**{kind: strength}), trials[::4], plant, seconds=1.0, noise=noise, seed=start)
        error = identify(as_fit(matrix_of(records, plant)), Settings()).error["fit"] or 1.0
        excess = float(np.sqrt(max(error**2 - noise**2, (0.02 * noise) ** 2)))
        if abs(excess / goal - 1) < 0.15:
            break
        strength *= float(np.clip(goal / excess, 0.2, 5.0))
    records = measure_all(Outside(**{kind: strength}), trials, plant, seconds=2.0, noise=noise, seed=start)
    return matrix_of(records, plant), strength


def label(what: str, seed: int, noise: float = 0.01) -> dict[str, Any]:
    """A wrong mass, stiffness or gain on one run, which lifts its error to at least 1.5 times its floor."""
    rng = np.random.default_rng([seed, 3000 + ("mass", "stiffness", "gain").index(what)])
    machine = Machine(drawn_plant(rng), {}, noise, False, int(rng.integers(1 << 30)))
    matrix = machine.measured()
    fitted = matrix.of_use("fit")
    run = fitted[int(rng.integers(len(fitted)))]
    sizes = {"mass": 0.3, "stiffness": 5e3, "gain": 0.02}
    sign, size = float(rng.choice([-1.0, 1.0])), sizes[what]
    for _ in range(12):
        wrong = _mislabelled(run, what, sign * size)
        changed = replace(matrix, runs=tuple(wrong if r is run else r for r in matrix.runs))
        error = next(r.error for r in identify(changed, Settings()).runs if r.id == run.id)
        if error >= 1.5 * noise:
            break
        size, sign = 1.5 * size, 1.0
    row = {"kind": "label", "matrix": "full", "noise": noise, "seed": seed, "hidden": {what: size}, "run": run.id}
    found = judged(changed, {})
    return row | found | {"named": [run.id, what] in found["suspects"], "lifted": error / noise}


def _mislabelled(run: Run, what: str, change: float) -> Run:
    specimen = run.specimen or Specimen()
    if what == "gain":
        return replace(run, gain=run.Kp * (1 + change))
    name = {"mass": "mass", "stiffness": "stiffness"}[what]
    return replace(run, specimen=replace(specimen, **{name: max(getattr(specimen, name) + change, 0.0)}))


def noisy(kind: str, seed: int, share: float = 0.01, small: bool = True) -> dict[str, Any]:
    """Noise of some kind; nothing hidden, with an odd seed one effect at 3 times the noise."""
    rng = np.random.default_rng([seed, 5000 + tuple(NOISES).index(kind), *[0] * (not small)])
    machine = Machine(drawn_plant(rng), {}, share, small, int(rng.integers(1 << 30)))
    hidden: dict[str, float] = {}
    while seed % 2 and not hidden:
        name = str(rng.choice([n for n in NAMES if n not in OFFSET]))
        strength, reached = strength_for(machine, name, 3.0)
        hidden = {name: strength} if reached >= _REACHED * 3.0 * share else {}
    clean = replace(machine, hidden=hidden, noise=0.0).measured()
    matrix = "small" if small else "full"
    row = {"kind": "noise", "matrix": matrix, "noise": share, "seed": seed, "of": kind, "hidden": hidden}
    return row | judged(with_noise(clean, kind, share, seed), hidden)


def outcome(machine: Machine) -> dict[str, Any]:
    """What the diagnosis says of a machine."""
    return judged(machine.measured(), machine.hidden)


def judged(
    matrix: Matrix,
    hidden: dict[str, float] | Any,
    custom: tuple[Effect, ...] = (),
    most: int = CRITERIA.selection.usual,
) -> dict[str, Any]:
    """Fit, diagnose with the catalogue and effects of one's own, and compare with the truth."""
    fit = identify(matrix, Settings())
    begun = time.perf_counter()
    found = diagnose(matrix, fit, custom=custom, most=most)
    last = found.ladder[-1]
    floor = found.noise_floor
    return {
        "error": fit.error["fit"],
        "floor": floor["fit"],
        "found": list(found.verdict.effects),
        "groups": [list(group) for group in found.verdict.indistinguishable],
        "first": [c.effect for c in found.candidates[:3]],
        "first_group": list(found.candidates[0].group),
        "strengths": {name: _strength(found, name) for name in found.verdict.effects},
        "after": last.error["fit"],
        "verify": (last.error["verify"] or 0) / (floor["verify"] or 1),
        "unexplained": found.verdict.unexplained,
        "proposed": [one.equation for one in found.proposals or ()],
        "suspects": [[s.run, s.what] for s in found.verdict.suspects],
        "named": named(found, set(hidden)),
        "seconds": round(time.perf_counter() - begun, 1),
        **sure(found),
    }


def _strength(found: Diagnosis, name: str) -> float:
    """The effect's first parameter on the last step."""
    return next(p.value for key, p in found.ladder[-1].parameters.items() if key.startswith(f"{name}."))


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

"""Blind trials with clutter: one strong effect among weak ones, some of the catalogue, some that no list holds.

The strong one leaves the linear model five times the noise, each weak one 0.3 to 1 times the noise beside it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ident.diagnosis.criteria import CRITERIA
from ident.effects import effect
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.workflows import identify
from tests.blind.machines import (
    OFFSET,
    SECONDS,
    Machine,
    drawn_plant,
    drawn_shapes,
    linear_error,
    matrix_of,
    runs_away,
    strength_for,
)
from tests.blind.trial import NAMES, judged
from tests.reference import nonlinear_reference as reference
from tests.reference import qian_reference as linear
from tests.reference.outside_reference import X

STRONG, WEAK = 5.0, (0.3, 1.0)  # of the noise: the linear error with the strong one, what each weak one adds
OUTSIDE = ("valve_temperature", "bent_recorder", "drifting_recorder")
"""What no list holds: each run's flow gain is off, the recorder bends as the square, or it drifts with time."""
_COUNTS = (3, 4, 5)  # of weak ones
_FROM_OUTSIDE = 0.3  # of them
_REACHED = 0.85  # of what is wanted


@dataclass(frozen=True)
class Cluttered(Machine):
    """A machine with what no list holds beside what is `hidden` of the catalogue, strengths by name."""

    outside: Mapping[str, float] = field(default_factory=dict)

    def measured(self, seconds: float = SECONDS, every: int = 1) -> Matrix:
        """Its test matrix, from the reference."""
        strengths = {f"{name}.{effect(name).strength.symbol}": value for name, value in self.hidden.items()}
        f, trials = reference.named({**self.shapes, **strengths}), self.trials[::every]
        records = []
        for number, trial in enumerate(trials):
            warm = np.random.default_rng([self.seed, 1, number]).standard_normal()
            plant = self.plant._replace(Z0=self.plant.Z0 * (1 + self.outside.get("valve_temperature", 0.0) * warm))
            of_run = (self.seed + 7919 * number) % (1 << 30)
            (record,) = reference.measure_all(f, [trial], seconds=seconds, noise=0.0, seed=of_run, plant=plant)
            records.append(record._replace(displacement=self._recorded(record.displacement, number)))
        return matrix_of(records, self.plant)

    def _recorded(self, x: np.ndarray, number: int) -> np.ndarray:
        """What stands in the record of a displacement (m), (n,): bent, drifting and noisy."""
        bent, drift = (self.outside.get(name, 0.0) for name in ("bent_recorder", "drifting_recorder"))
        noise = np.random.default_rng([self.seed, 2, number]).standard_normal(len(x))
        return x + bent * x**2 / X + drift * X * np.arange(len(x)) / linear.SAMPLE_RATE + self.noise * x.std() * noise


def clutter(seed: int, noise: float = 0.01, small: bool = False) -> dict[str, Any]:
    """One strong effect among three to five weak ones: whether it is named, and what is named beside."""
    rng = np.random.default_rng([seed, 6000, small])
    machine = drawn(rng, noise, small)
    while runs_away(matrix := machine.measured()):
        machine = drawn(rng, noise, small)
    names = tuple(machine.hidden)
    oracle = identify(matrix, Settings(effects=names)).error["verify"] or 0.0
    row = {
        "kind": "clutter",
        "matrix": "small" if small else "full",
        "noise": noise,
        "seed": seed,
        "hidden": dict(machine.hidden),
        "shapes": dict(machine.shapes),
        "outside": dict(machine.outside),
        "strong": names[0],
        "oracle": oracle / noise,
    }
    found = judged(matrix, machine.hidden, most=CRITERIA.selection.most)
    return row | found | said(found, names)


def drawn(rng: np.random.Generator, noise: float, small: bool) -> Cluttered:
    """A machine with the strong effect first, the weak ones behind it."""
    empty = Cluttered(drawn_plant(rng), {}, noise, small, int(rng.integers(1 << 30)))
    hidden: dict[str, float] = {}
    shapes: dict[str, float] = {}
    outside: dict[str, float] = {}
    count = 1 + int(rng.choice(_COUNTS))
    while len(hidden) + len(outside) < count:
        wanted = float(np.hypot(1.0, rng.uniform(*WEAK))) if hidden else STRONG
        if hidden and rng.random() < _FROM_OUTSIDE and len(outside) < len(OUTSIDE):
            name = str(rng.choice([one for one in OUTSIDE if one not in outside]))
            outside[name] = _outside_strength(empty, name, wanted)
            continue
        name = str(rng.choice([one for one in NAMES if one not in hidden and one not in OFFSET]))
        of = drawn_shapes(rng, name)
        strength, reached = strength_for(replace(empty, shapes=of), name, wanted)
        excess, asked = (np.sqrt(max(error**2 - 1, 0.0)) for error in (reached / noise, wanted))
        if excess >= _REACHED * asked:
            hidden[name] = strength
            shapes |= of
    return replace(empty, hidden=hidden, shapes=shapes, outside=outside)


def _outside_strength(machine: Cluttered, name: str, wanted: float, rounds: int = 4) -> float:
    """The strength with which the linear error is `wanted` times the noise: what it adds grows in proportion."""
    strength = 0.01
    for _ in range(rounds):
        error = linear_error(replace(machine, outside={name: strength})) / machine.noise
        strength *= float(np.clip(np.sqrt((wanted**2 - 1) / max(error**2 - 1, 1e-4)), 0.1, 10.0))
    return strength


def said(found: dict[str, Any], names: tuple[str, ...]) -> dict[str, bool]:
    """Of what a diagnosis found: whether the first of the names is there, and no name that is in no class of theirs.

    There in itself or in a group of at most three; a class is what the data cannot tell apart, however many they are.
    """

    def classes(most: int) -> list[set[str]]:
        groups = [set(group) for group in found["groups"] if len(group) <= most]
        return [{name}.union(*(group for group in groups if name in group)) for name in found["found"]]

    return {
        "named": any(names[0] in alike for alike in classes(3)),
        "clean": all(alike & set(names) for alike in classes(99)),
    }

"""Blind trials of drives with a load behind a spring, or with none: what is named where drive or load is recorded.

python -m tests.blind.second_mass 0 10    seeds

A motor in V, its speed in rad/s or in units of 1, through a sensor with an offset of up to a deviation. Half of them
have friction at the drive, a quarter a counter without direction, two thirds a part of the mass behind a spring.
"""

from __future__ import annotations

import argparse
from collections import Counter
from dataclasses import dataclass, replace

import numpy as np

from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.presets.test_two_masses import SEEN, drawn, run
from tests.reference.coupled_masses import Coupled

_STIFF = 1e3  # times as stiff: nothing of the spring is seen


@dataclass(frozen=True)
class Drive:
    """One machine: what is hidden of its spring ("" is none), and how it was recorded."""

    seed: int
    hidden: str
    dry: bool
    counted: bool
    unit: str
    offset: float

    @classmethod
    def drawn(cls, seed: int) -> Drive:
        """A drive by its seed."""
        rng = np.random.default_rng([534, seed])
        hidden, counted = str(rng.choice(["", *SEEN])), bool(rng.integers(4) == 0)
        offset = 0.0 if counted else rng.uniform(-1, 1) * rng.integers(2)
        return cls(seed, hidden, bool(rng.integers(2)), counted, str(rng.choice(["rad/s", "1"])), float(offset))

    @property
    def parts(self) -> Coupled:
        """Its masses; without anything hidden they are one."""
        of = drawn(self.seed, 6.0 if self.dry else 0.0)
        return of if self.hidden else replace(of, stiffness=_STIFF * of.stiffness, between=30.0 * of.between)

    def matrix(self) -> Matrix:
        """A run to fit and one to verify."""
        seen = SEEN.index(self.hidden) if self.hidden else 0
        return Matrix(Actuator("TWO"), tuple(self._run(seen, use) for use in ("fit", "verify")))

    def _run(self, seen: int, use: str) -> Run:
        one = run(self.parts, 2 * self.seed + (use == "verify"), seen, use)
        speed = one.channels["velocity"]
        speed = np.abs(speed) if self.counted else speed + self.offset * speed.std()
        units = {**one.units, "velocity": self.unit}
        return replace(one, channels={**one.channels, "velocity": speed}, units=units)


def trial(seed: int) -> Counter[str]:
    """What was right of one: the spring where it is hidden, and none where it is not."""
    drive = Drive.drawn(seed)
    matrix = drive.matrix()
    fit = identify(matrix, Settings(model=""))
    verdict = diagnose(matrix, fit, propose=False).verdict
    group = {name for names in verdict.indistinguishable if len(names) <= 3 for name in names}
    named = {*verdict.effects, *group}
    right = drive.hidden in named if drive.hidden else not set(SEEN) & set(verdict.effects)
    said = f"{', '.join(verdict.effects) or 'nothing'} {verdict.standing}"
    print(f"{drive}: {fit.model}, {said}: {'right' if right else 'wrong'}", flush=True)
    kind = "with a spring" if drive.hidden else "without"
    return Counter({kind: 1, f"{kind}, right": int(right), f"{kind}, motor": int(fit.model == "motor")})


def main() -> None:
    """Trials one after the other, then the counts."""
    parser = argparse.ArgumentParser()
    parser.add_argument("first", type=int)
    parser.add_argument("end", type=int)
    asked, counts = parser.parse_args(), Counter[str]()
    for seed in range(asked.first, asked.end):
        counts += trial(seed)
    print("; ".join(f"{kind} {count}" for kind, count in sorted(counts.items())))


if __name__ == "__main__":
    main()

"""What the four blocks lack, ranked: each of four extras is refitted with T, B and I0 over the frequency records.

The model's residual itself is :class:`ident.bench.residual.Residual`; whoever ranks by other means starts there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ident.bench.least_squares import Solution, solve
from ident.bench.model import Model
from ident.bench.records import Record
from ident.bench.residual import Residual, errors, observe

REFITTED = ("T", "B", "I0")
MEANING = {
    "delay": ("s", "pure delay before the lag"),
    "second_lag": ("s", "second lag in series with T"),
    "stiction": ("Pa", "pressure above friction that breaks the link loose"),
    "load": ("Pa/m", "load that grows with the position, so that the speed depends on it"),
}
"""Unit and meaning of each extra."""
_TRIED = (0.05, 0.2, 0.6, 1.5)
_LEAST = 1e-2  # of the error: a smaller gain is none


@dataclass(frozen=True)
class Candidate:
    """An extra with the strength that fits best, and the mean position error of the frequency records with it."""

    name: str
    strength: float
    unit: str
    error: float
    without: float
    model: Model

    @property
    def gain(self) -> float:
        """The share of the error that it takes away."""
        return 1.0 - self.error / self.without if self.without else 0.0

    @property
    def helps(self) -> bool:
        """Whether it does at all."""
        return self.gain > _LEAST


def rank(model: Model, records: Sequence[Record]) -> tuple[Candidate, ...]:
    """The four extras, best first, against the model refitted without any."""
    observed = observe(records, pressure=False, drifting=True)
    plain = solve(Residual(model, observed, REFITTED), steps=6)

    def error(solution: Solution) -> float:
        return float(np.mean(list(errors(solution.model, observed).values())))

    without, out = error(plain), []
    for name, (unit, _) in MEANING.items():
        tried = [solve(Residual(start, observed, (*REFITTED, name)), steps=8) for start in _starts(plain.model, name)]
        best = min(tried, key=lambda solution: solution.cost)
        out.append(Candidate(name, best.values[name], unit, min(error(best), without), without, best.model))
    return tuple(sorted(out, key=lambda candidate: candidate.error))


def _starts(model: Model, name: str) -> list[Model]:
    """Models with some of an extra, the lag made shorter by what a second lag or a delay takes over."""
    size = {"delay": model.T, "second_lag": model.T, "stiction": model.dPfr, "load": 10.0 * model.dPfr}[name]
    out = []
    for share in _TRIED:
        start = model.with_values({name: share * size})
        if name in ("delay", "second_lag"):
            start = replace(start, T=max(model.T - min(share, 0.8) * size, 0.1 * model.T))
        out.append(start)
    return out

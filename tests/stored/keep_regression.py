"""Fits as this version finds them, kept for the recheck of later ones: `python -m tests.stored.keep_regression`.

Each is of a few short runs of the independent reference, whose machine hides what the fit has: a linear one with each
hold of the command, and one effect each. Keep them anew only where a change of what is found is meant.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.workflows import identify
from tests.blind.machines import matrix_of
from tests.reference import nonlinear_reference as reference
from tests.reference import qian_reference as linear

FILE = Path(__file__).with_name("regression.json")
SEARCH = {"population": 16, "generations": 12, "elite": 4}
SEED = 11


@dataclass(frozen=True)
class Case:
    """What a machine hides, by effect and symbol, and how its command is held."""

    effect: str = ""
    hidden: Mapping[str, float] = field(default_factory=dict)
    hold: str = "linear"

    def matrix(self) -> Matrix:
        """Six runs of half a second."""
        trials = linear.trials()
        chosen = [trials[place] for place in (0, 13, 26, 39, 52, -2)]
        length = {"seconds": 0.5, "noise": 0.005, "seed": SEED}
        if self.effect:
            records = reference.measure_all(reference.named(self.hidden), chosen, **length)
        else:
            records = linear.measure_all(linear.Plant(), chosen, hold=self.hold, **length)
        found = matrix_of(records, linear.Plant())
        return replace(found, runs=tuple(replace(run, hold=self.hold) for run in found.runs))

    def fitted(self) -> FitResult:
        """The fit that is approved."""
        effects = (self.effect,) if self.effect else ()
        return identify(self.matrix(), Settings(effects=effects, seed=SEED, options=SEARCH))


CASES = {
    "linear": Case(),
    "held": Case(hold="zoh"),
    "dead_zone": Case("dead_zone", {"dead_zone.h": 8e-5}),
    "coulomb_friction": Case("coulomb_friction", {"coulomb_friction.Fc": 40.0}),
    "quadratic_damping": Case("quadratic_damping", {"quadratic_damping.c2": 1e4}),
}


def stored() -> dict[str, FitResult]:
    """What was kept."""
    return {name: FitResult.from_json(data) for name, data in json.loads(FILE.read_text(encoding="utf-8")).items()}


if __name__ == "__main__":
    kept = {name: replace(case.fitted(), evolution=(), seconds=0.0).to_json() for name, case in CASES.items()}
    FILE.write_text(json.dumps(kept, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")

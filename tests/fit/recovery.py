"""One hidden effect in the reference's data, and what a fit with that effect makes of it.

As a script it prints the table of every effect:  python -m tests.fit.recovery [EFFECT ...]
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from functools import cache

from ident.effects import EFFECTS, effect
from ident.effects.effect import Effect
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.workflows import identify
from tests.blind.machines import matrix_of
from tests.reference import nonlinear_reference as reference
from tests.reference import qian_reference as linear

NOISE = 0.005
SECONDS = 2.0
WANTED = 5 * NOISE  # the error that the linear model is to have
STRENGTHS = {"dead_zone": 2.03125e-4, "coulomb_friction": 21.875, "sensor_lag": 3e-3, "null_bias": 7.1875e-4}
"""What `strength_for` chooses with seed 1: half a dozen fits each."""


@dataclass(frozen=True)
class Recovery:
    """The hidden strength, the linear fit and the fit with the effect."""

    effect: Effect
    truth: float
    linear: FitResult
    fit: FitResult

    @property
    def found(self) -> float:
        """The strength found."""
        return self.fit.values[f"{self.effect.name}.{self.effect.strength.name}"]

    @property
    def std_error(self) -> float | None:
        """Its standard error; None where the fit says that the data do not determine it."""
        return self.fit.parameters[f"{self.effect.name}.{self.effect.strength.name}"].std_error

    @property
    def recovered(self) -> bool:
        """Within 3 %, or within 3 standard errors of a strength that is determined."""
        return abs(self.found - self.truth) <= max(0.03 * abs(self.truth), 3 * (self.std_error or 0.0))


def matrix(name: str, strength: float, seed: int, seconds: float = SECONDS, every: int = 1) -> Matrix:
    """The paper's matrix of 63 + 21 runs with one hidden effect, from the reference, position in 18 bits."""
    hidden = reference.named({f"{name}.{effect(name).strength.symbol}": strength})
    records = reference.measure_all(hidden, linear.trials()[::every], seconds=seconds, noise=NOISE, seed=seed)
    return matrix_of(records, linear.Plant())


def strength_for(name: str, seed: int, wanted: float = WANTED) -> float:
    """The strength with which the best linear model is `wanted` off, or the largest that is physical."""
    top = effect(name).strength.upper

    def error(strength: float) -> float:
        return float(identify(matrix(name, strength, seed, 1.0, 4), Settings()).error["fit"] or 0)

    if error(top) <= wanted:
        return top
    low, high = 0.0, top
    for _ in range(5):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if error(middle) < wanted else (low, middle)
    return 0.5 * (low + high)


@cache
def recovery(name: str, seed: int) -> Recovery:
    """Hide the effect, fit without it and with it."""
    truth = STRENGTHS[name] if seed == 1 and name in STRENGTHS else strength_for(name, seed)
    data = matrix(name, truth, seed)
    return Recovery(effect(name), truth, identify(data, Settings()), identify(data, Settings(effects=(name,))))


def line(found: Recovery) -> str:
    """A row of the table."""
    e = found.effect
    miss = 100 * (found.found / found.truth - 1)
    errors = f"{100 * (found.linear.error['fit'] or 0):.2f} | {100 * (found.fit.error['fit'] or 0):.3f} | "
    errors += f"{100 * (found.fit.error['verify'] or 0):.3f}"
    share = "none" if found.std_error is None else f"{100 * found.std_error / abs(found.truth):.2f}"
    outcome = "yes" if found.recovered else "NO"
    return f"| {e.name} | {found.truth:.3g} {e.strength.unit} | {errors} | {miss:+.2f} | {share} | {outcome} |"


if __name__ == "__main__":
    seed = 1
    names = [n for n in sys.argv[1:] if not n.startswith("--seed=")] or [e.name for e in EFFECTS]
    for argument in sys.argv[1:]:
        if argument.startswith("--seed="):
            seed = int(argument.removeprefix("--seed="))
    columns = "effect, hidden strength, error without it in %, with it in %, at Kp = 6 in %, deviation in %"
    print("| " + " | ".join((*columns.split(", "), "std error in %", "recovered")) + " |")
    print("|---|---|---|---|---|---|---|---|")
    for name in names:
        print(line(recovery(name, seed)), flush=True)

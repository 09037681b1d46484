"""Machines with an effect that no list holds, and its equation in the words of a user."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.workflows import identify
from tests.blind.machines import as_fit, drawn_plant, matrix_of, runs_away
from tests.reference import qian_reference as linear
from tests.reference.unlisted_reference import KINDS, MS, NAMES, P0, V0, VS, Hidden, X, drawn, measure_all

MODEL = "qian2014"
KIND = {name: kind for kind, names in KINDS.items() for name in names}
_FIT, _VERIFY = 24, 6  # runs of the smaller matrix
_CLOSE, _TRIES = 0.1, 12  # of the wanted excess
_EQUATIONS: dict[str, tuple[str, ...]] = {
    "square_leakage": ("Q = Q - s * A * V0 * P * abs(P) / P0**2",),
    "cubic_damping": ("R = R + s * A * P0 * (v / V0)**3",),
    "gain_hill": ("Q = Q * (1 + s * exp(-((x - a) / b)**2))",),
    "position_damping": ("R = R + s * A * P0 * (x / X0)**2 * v / V0",),
    "speed_gain": ("Q = Q * (1 + s * abs(v) / V0)",),
    "loaded_friction": ("R = R + s * A * abs(P) * slip",),
    "relief_valve": ("Q = Q - s * A * V0 * max(P - a, 0) / P0",),
    "bumper": ("R = R + s * A * P0 * max(x - a, 0) / X0",),
    "wide_opening": ("w = w + s * max(w - a, 0)",),
    "feedback_play": ("p := clip(p, x - s * X0, x + s * X0)", "e = e + Kp * (x - p)"),
    "yielding_element": ("p := clip(p, x - a, x + a)", "R = R + s * A * P0 * (x - p) / a"),
    "flow_hysteresis": ("p := clip(p, w - a, w + a)", "w = w + s * (p - w)"),
    "late_leakage": ("Q = Q - s * A * V0 * lag(P, a) / P0",),
    "mount": ("R = R + s * A * P0 * (x - lag2(x, b / a**2, 1 / a**2)) / X0",),
    "late_friction": ("R = R + s * A * P0 * lag(slip, a)",),
    "pulsation": ("R = R + s * A * P0 * sin(2 * pi * (a * t + b))",),
    "warming_gain": ("Q = Q * (1 + s * (1 - exp(-t / a)))",),
    "running_in": ("R = R + s * A * P0 * exp(-t / a) * slip",),
    "mass_gain": ("Q = Q * (1 + s * mL / MS)",),
    "gain_friction": ("R = R + s * A * P0 * Kp / 10 * slip",),
    "tilted_leakage": ("Q = Q - s * A * V0 * mL / MS * P / P0",),
    "tapered_piston": ("Q = Q - s * A * x / X0 * v", "R = R - s * A * x / X0 * P"),
    "bellows": ("Q = Q - s * A * (x / X0)**2 * v", "R = R - s * A * (x / X0)**2 * P"),
    "breathing": ("Q = Q - s * A * abs(P) / P0 * v", "R = R - s * A * abs(P) / P0 * P"),
}
_SIZES = {"X0": X, "V0": V0, "P0": P0, "MS": MS, "slip": f"tanh(v / {VS!r})"}
_PLACES = {"e": "controller", "w": "spool", "Q": "flow", "R": "load"}


def written(hidden: Hidden) -> dict[str, Any]:
    """The definition of an effect, its shapes as they are and its strength to be found."""
    numbers = {**_SIZES, "a": repr(hidden.a), "b": repr(hidden.b)}
    lines = [re.sub(r"[A-Za-z_]\w*", lambda m: f"{numbers.get(m[0], m[0])}", text) for text in _EQUATIONS[hidden.name]]
    return {
        "name": f"true_{hidden.name}",
        "place": _PLACES[lines[-1].split(" = ")[0]],
        "equation": lines,
        "strength": {"symbol": "s", "unit": "1", "lower": min(0.0, 4 * hidden.s), "upper": max(0.0, 4 * hidden.s)},
        "meaning": f"{hidden.name}, written down",
    }


@dataclass(frozen=True)
class Secret:
    """A machine with an effect that no list holds; `noise` is its share of each run's output."""

    plant: linear.Plant
    hidden: Hidden
    noise: float
    seed: int
    full: bool = False

    @property
    def trials(self) -> list[linear.Trial]:
        """The runs of its matrix: all 84, or 24 and 6 of them."""
        everything = linear.trials()
        uses = [[trial for trial in everything if trial.use == use] for use in ("fit", "verify")]
        return everything if self.full else [*_spread(uses[0], _FIT), *_spread(uses[1], _VERIFY)]

    def measured(self, trials: Sequence[linear.Trial] | None = None, noise: float | None = None) -> Matrix:
        """Its test matrix, or other runs, from the reference."""
        records = measure_all(
            self.hidden,
            self.trials if trials is None else trials,
            self.plant,
            seconds=2.0 if self.full else 1.0,
            noise=self.noise if noise is None else noise,
            seed=self.seed,
        )
        return matrix_of(records, self.plant)

    def linear_error(self) -> float:
        """Eq. (17) of the refitted linear model, on some of the runs; 1 where one leaves the stroke."""
        matrix = replace(self, full=False).measured(self.trials[:: 9 if self.full else 3])
        if runs_away(matrix):
            return 1.0
        return float(identify(as_fit(matrix), Settings(model=MODEL)).error["fit"] or 0.0)

    def oracle(self) -> FitResult:
        """The refitted model with the true equation: where it does not reach the floor the trial asks too much."""
        own = written(self.hidden)
        return identify(self.measured(), Settings(model=MODEL, effects=(own["name"],), custom=(own,)))


def _spread(trials: Sequence[linear.Trial], count: int) -> list[linear.Trial]:
    return [trials[i] for i in np.linspace(0, len(trials) - 1, count).round().astype(int)]


def secret(name: str, seed: int, level: float, full: bool = False) -> tuple[Secret, float]:
    """A machine whose linear error is `level` floors as far as that can be reached, and that error in floors."""
    rng = np.random.default_rng([seed, 9000 + NAMES.index(name), round(10 * level)])
    machine = Secret(drawn_plant(rng), drawn(name, rng), rng.uniform(0.005, 0.01), int(rng.integers(1 << 30)), full)
    goal, sign, low, high = float(np.sqrt(level**2 - 1)), machine.hidden.s, 0.0, np.inf
    strength, found = 0.1, 0.0
    for _ in range(_TRIES):
        machine = replace(machine, hidden=machine.hidden._replace(s=sign * strength))
        found = machine.linear_error() / machine.noise
        excess = float(np.sqrt(max(found**2 - 1, 4e-4)))
        if abs(excess / goal - 1) < _CLOSE:
            break
        low, high = (strength, high) if excess < goal else (low, strength)
        guess = strength * float(np.clip(goal / excess, 0.25, 4.0))
        strength = guess if low < guess < high else float(np.sqrt(max(low, 0.25 * high) * high))
    return machine, found

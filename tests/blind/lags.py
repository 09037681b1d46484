"""Blind trials of what follows its command like a lag: hysteresis, play, a second capacity, a dead zone or nothing.

python -m tests.blind.lags 169801 169860   [--out FILE] [--minutes N]

A voltage drives a place without a unit of its own, or heats. Two runs are fitted and one is held back. Whether what is
hidden shows is decided before the program runs: the lag alone, refitted, leaves 1.3 times the noise of the run held
back. Right is a lag whose verdict names what is hidden and nothing else, or a group of at most three with it.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.blind.campaign import add, rows
from tests.blind.lags_table import HIDDEN, ROWS, lag_rates
from tests.blind.sure import sure

Array = NDArray[np.float64]
FINE = 8  # steps of the reference a sample
LEAST_FLOORS = 1.3


@dataclass(frozen=True)
class Lag:
    """A lag of `tau` samples; `strength` (0 to 1) of what is hidden, `noise` in deviations of the output."""

    seed: int
    hidden: str
    tau: float
    strength: float
    slow: float
    noise: float
    held: bool
    gain: float
    rate: float
    count: int

    @classmethod
    def drawn(cls, seed: int) -> Lag:
        """All of it by the seed; the kinds come in turn."""
        rng = np.random.default_rng([181, seed])
        return cls(seed, HIDDEN[seed % len(HIDDEN)], 10 ** rng.uniform(0.2, 1.3), rng.uniform(0.3, 1.0),
                   rng.uniform(4.0, 12.0), 10 ** rng.uniform(-2.6, -1.7), bool(rng.integers(2)),
                   10 ** rng.uniform(-2, 2), 10 ** rng.uniform(-1, 2), int(rng.integers(500, 1500)))  # fmt: skip

    def command(self, number: int) -> Array:
        """Levels that are held, or reached by ramps, up to 4 V, from none on."""
        rng, gap = np.random.default_rng([182, self.seed, number]), max(3.0 * self.tau, 12.0)
        times = np.concatenate(
            [[0.0], 5.0 + np.cumsum(rng.uniform(0.5 * gap, 2.0 * gap, 1 + int(self.count / gap * 2)))]
        )
        levels = np.concatenate([[0.0], rng.uniform(-4.0, 4.0, len(times) - 1)])
        k = np.arange(self.count)
        return levels[np.searchsorted(times, k, "right") - 1] if self.held else np.interp(k, times, levels)

    def answer(self, command: Array, hidden: bool = True) -> Array:
        """The output of a command, without noise, by Heun's steps, many a sample."""
        k = np.arange(self.count * FINE) / FINE
        fine = command[k.astype(int)] if self.held else np.interp(k, np.arange(self.count), command)
        what, s = (self.hidden if hidden else ""), self.strength
        if what == "drive_hysteresis":
            fine = fine + s * _relays(fine, np.random.default_rng([183, self.seed]))
        elif what == "backlash":
            fine = _played(fine, 0.2 + 0.8 * s)
        elif what == "dead_zone":
            fine = np.sign(fine) * np.maximum(np.abs(fine) - 0.2 - s, 0.0)
        share = s if what == "second_capacity" else 0.0
        quick, slow, later = 1.0 / (self.tau * FINE), 1.0 / (self.slow * self.tau * FINE), fine
        if not self.held:
            later = np.append(fine[1:], fine[-1])
        own, other, ways = 0.0, 0.0, np.empty(len(fine))
        for i, (u, then) in enumerate(zip(fine, later, strict=True)):
            ways[i] = own
            a, b = quick * (u - own - share * (own - other)), slow * (own - other)
            there, beside = own + a, other + b
            own += 0.5 * (a + quick * (then - there - share * (there - beside)))
            other += 0.5 * (b + slow * (there - beside))
        return self.gain * ways[::FINE]

    def run(self, number: int) -> Run:
        """One record; the third is held back."""
        command = self.command(number)
        clean = self.answer(command)
        noise = self.noise * np.std(clean) * np.random.default_rng([184, self.seed, number]).standard_normal(self.count)
        channels, units = {"command": command, "displacement": clean + noise}, {"command": "V", "displacement": "1"}
        use, hold = "verify" if number == 2 else "fit", "zoh" if self.held else "linear"
        return Run(f"run-{number}", "", self.rate, channels, units, use=use, hold=hold)

    @property
    def shown(self) -> bool:
        """Whether the lag alone, refitted to the first run, leaves enough of the one held back."""
        if not self.hidden:
            return True
        seen, unseen = ((u, self.answer(u)) for u in map(self.command, (0, 2)))

        def left(p: Array, u: Array, y: Array) -> Array:
            other = Lag(**{**vars(self), "tau": self.tau * float(np.exp(np.clip(p[0], -3, 3))), "hidden": ""})
            off = y - p[1] * other.answer(u)
            return np.asarray((off - off.mean()) / y.std())

        best = least_squares(left, np.array([0.0, 1.0]), args=seen, diff_step=1e-3, max_nfev=15).x
        return bool(np.hypot(np.std(left(best, *unseen)), self.noise) >= LEAST_FLOORS * self.noise)


def _relays(command: Array, rng: np.random.Generator) -> Array:
    """The way of a piezo beside its voltage, after Preisach: relays of all widths, as large as the command."""
    width = rng.uniform(1.0, 4.0)
    up, down = np.meshgrid(*2 * [np.linspace(-4.2, 4.2, 31)])
    weight, state = np.where(up >= down, np.exp(-(up - down) / width), 0.0), np.sign(-(up + down))
    ways = np.empty(len(command))
    for i, u in enumerate(command):
        state = np.where(u >= up, 1.0, np.where(u <= down, -1.0, state))
        ways[i] = np.sum(weight * state)
    return np.std(command) * (ways - ways[0]) / np.std(ways)


def _played(command: Array, half: float) -> Array:
    """What moves behind a play of `half` to each side."""
    place, ways = 0.0, np.empty(len(command))
    for i, u in enumerate(command):
        place = ways[i] = min(max(place, u - half), u + half)
    return ways


def trial(seed: int) -> dict[str, Any]:
    """One machine by its seed: what the documented way says of it."""
    of, begun = Lag.drawn(seed), time.process_time()
    row: dict[str, Any] = {"seed": seed, "hidden": of.hidden, "noise": of.noise, "shown": of.shown}
    if not row["shown"]:
        return row
    fit = identify(matrix := Matrix(Actuator("L"), tuple(map(of.run, range(3)))), Settings(model=""))
    found = diagnose(matrix, fit, propose=False)
    verdict = found.verdict
    grouped = {name for group in verdict.indistinguishable if len(group) <= 3 for name in group}
    named = of.hidden in {*verdict.effects, *grouped} and len(verdict.effects) == 1
    return (
        row
        | sure(found)
        | {
            "model": fit.model,
            "structure": fit.model == "first_order",
            "effects": list(verdict.effects),
            "groups": [list(group) for group in verdict.indistinguishable],
            "right": named if of.hidden else not verdict.effects,
            "errors": [found.ladder[0].error.get("verify"), found.ladder[-1].error.get("verify")],
            "seconds": round(time.process_time() - begun, 1),
        }
    )


def main() -> None:
    """Run what is asked for and is not there yet, and sum up by what is hidden."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int)
    parser.add_argument("--out", type=Path, default=ROWS)
    parser.add_argument("--minutes", type=float, default=1e9)
    asked = parser.parse_args()
    done, end = {row["seed"] for row in rows(asked.out)}, time.monotonic() + 60 * asked.minutes
    for seed in range(asked.first, asked.last + 1):
        if seed in done or time.monotonic() > end:
            continue
        row = trial(seed)
        add(row, asked.out)
        print(
            {key: row.get(key) for key in ("seed", "hidden", "model", "effects", "groups", "errors", "right")},
            flush=True,
        )
    print("\n".join(lag_rates(rows(asked.out))))


if __name__ == "__main__":
    main()

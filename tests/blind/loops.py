"""Loops and machines that oscillate by themselves, and such as do not: recursions of their own.

A position loop with a lag or with a dead time, whose drive saturates or does not, and a mass whose damper drives it
while it swings little (van der Pol 1926). The command rests, steps, turns slowly or is noise.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from ident.run import Run

Array = NDArray[np.float64]
KINDS = ("lag", "dead time", "negative damper")
COMMANDS = ("rest", "steps", "sine", "noise")
NEAR = 0.02  # of its frequency, within which an oscillation is said right
FEWEST = 10  # periods of an oscillation that a record shows
APART = 0.05  # of the output's deviation, by which two records that began differently still differ at the end
_PARTS = 8  # steps of a sample


@dataclass(frozen=True)
class Loop:
    """One loop by its seed: `gain` over that at which it loses stability, `omega` there in radians a sample.

    `ratio` is that of its two times, `limit` of the drive in deviations of the command; `cycles` are those that the
    record is meant to hold.
    """

    seed: int
    stable: bool
    kind: str
    command: str
    rate: float
    omega: float
    ratio: float
    gain: float
    limit: float
    cycles: float
    unknown: bool
    noise: float

    @classmethod
    def drawn(cls, seed: int, stable: bool) -> Loop:
        """A loop by its seed; a stable one is 3 to 12 dB from losing stability, the other 1 to 8 dB beyond."""
        rng = np.random.default_rng([174, seed, stable])
        decibel = -rng.uniform(3.0, 12.0) if stable else rng.uniform(1.0, 8.0)
        return cls(
            seed, stable, str(rng.choice(KINDS)), str(rng.choice(COMMANDS)), float(10 ** rng.uniform(1.5, 3.5)),
            rng.uniform(0.1, 0.5), rng.uniform(0.2, 1.0), float(10 ** (decibel / 20)), rng.uniform(0.3, 3.0),
            float(10 ** rng.uniform(1.2, 2.2)), bool(rng.integers(3) == 0), rng.uniform(0.002, 0.01),
        )  # fmt: skip

    @property
    def count(self) -> int:
        """Samples of the record."""
        return max(400, round(self.cycles * 2 * pi / self.omega))

    @cached_property
    def clean(self) -> Array:
        """Without noise."""
        return self._moved(self._command())

    @cached_property
    def frequencies(self) -> tuple[float, float]:
        """Of the oscillation that has settled under a command at rest, and of one that still grows, in Hz."""
        own = 2 * pi / self.omega
        return self._crossed(self, round(150 * own)), self._crossed(replace(self, limit=1e9), round(12 * own))

    def _crossed(self, loop: Loop, samples: int) -> float:
        """The frequency by the crossings of the command's level, upwards, in the second half."""
        x = loop._moved(np.ones(samples))[samples // 2 :] - 1.0
        up = np.flatnonzero((x[:-1] < 0.0) & (x[1:] >= 0.0))
        at = up - x[up] / (x[up + 1] - x[up])
        return float((len(at) - 1) / (at[-1] - at[0])) * self.rate if len(at) > 1 else 0.0

    def near(self, frequency: float, growth: float) -> bool:
        """Whether a frequency (Hz) is within 2 % of that of the loop: one that grows passes from one to the other."""
        settled, growing = self.frequencies
        others = (settled, growing) if growth > 0.0 else (settled, settled)
        return (1.0 - NEAR) * min(others) <= frequency <= (1.0 + NEAR) * max(others)

    @property
    def periods(self) -> float:
        """Of the oscillation in the record."""
        return self.count * self.frequencies[0] / self.rate

    @cached_property
    def oscillates(self) -> bool:
        """Whether the record shows it: ten periods, of an oscillation that a command of noise does not put out.

        Beside a large command that moves all the time an oscillation may go out (Oldenburger 1957): the loop then
        forgets how it began, and two records of one command that begin differently end alike.
        """
        if self.periods < FEWEST or self.command != "noise":
            return self.periods >= FEWEST
        own = round(2 * pi / self.omega)
        ahead = np.where(np.arange(27 * own // 2) < own, 1.0, 0.0)
        other = self._moved(np.concatenate([ahead, self._command()]))[len(ahead) :]
        return bool(np.std((other - self.clean)[3 * self.count // 4 :]) > APART * self.clean.std())

    def run(self, use: str) -> Run:
        """The record."""
        rng = np.random.default_rng([175, self.seed, use == "verify"])
        y = self.clean + self.noise * self.clean.std() * rng.standard_normal(self.count)
        unit = "1" if self.unknown else "m"
        return Run(
            use,
            "",
            self.rate,
            {"command": self._command(), "displacement": y},
            {"command": unit, "displacement": unit},
            use=use,
        )

    def _command(self) -> Array:
        rng, n = np.random.default_rng([176, self.seed]), self.count
        t = np.arange(n)
        if self.command == "rest":
            return np.where(t < n // 20, 0.0, 1.0)
        if self.command == "steps":
            return np.repeat(rng.uniform(-1.5, 1.5, 6), n // 6 + 1)[:n]
        if self.command == "sine":
            return np.asarray(np.sin(rng.uniform(0.02, 0.1) * self.omega * t))
        lines = np.fft.rfft(rng.standard_normal(n))
        lines[np.fft.rfftfreq(n) > rng.uniform(0.3, 2.0) * self.omega / (2 * pi)] = 0.0
        found = np.fft.irfft(lines, n)
        return np.asarray(found / found.std())

    def _moved(self, u: Array) -> Array:
        if self.kind == "negative damper":
            return self._swung(u)
        one, two, critical, late = self._times()
        h, q, v, x, past = 1.0 / _PARTS, 0.0, 0.0, 0.0, [0.0] * (late + 1)
        most = self.limit * critical
        shown = np.empty(len(u))
        for k, now in enumerate(u.tolist()):
            shown[k] = x
            for _ in range(_PARTS):
                asked = self.gain * critical * (now - x)
                past.append(min(max(asked, -most), most))
                q += h * (past[-1 - late] - q) / one
                v += h * (q - v) / two if two else q - v
                x += h * v
        return shown

    def _times(self) -> tuple[float, float, float, int]:
        """Two lags in samples with the gain at the limit of stability, 1/sample, and the steps of the dead time."""
        if self.kind == "lag":
            one = 1.0 / self.omega / sqrt(self.ratio)
            return one, one * self.ratio, 1.0 / one + 1.0 / (one * self.ratio), 0
        one = self.ratio / self.omega
        late = (pi / 2 - np.arctan(self.ratio)) / self.omega
        omega = brentq(lambda w: w * late + np.arctan(w * one) - pi / 2, 1e-3 * self.omega, 10 * self.omega)
        return one, 0.0, float(omega * sqrt(1.0 + (omega * one) ** 2)), round(late * _PARTS)

    def _swung(self, u: Array) -> Array:
        """x'' = w² (u − x) − (a + b (x − u)²) x'; a < 0 drives it."""
        h, x, v, w = 1.0 / _PARTS, 0.0, 0.0, self.omega
        a = (0.3 if self.stable else -0.06) * w * abs(self.gain)
        b = 0.3 * w / self.limit**2
        shown = np.empty(len(u))
        for k, now in enumerate(u.tolist()):
            shown[k] = x
            for _ in range(_PARTS):
                v += h * (w * w * (now - x) - (a + b * (x - now) ** 2) * v)
                x += h * v
        return shown

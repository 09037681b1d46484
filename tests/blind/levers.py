"""Machines that are driven by levers, of which one may be missing in the record: recursions of their own.

A boom that its valve moves, a motor's speed, a mass on a spring, an arm with its weight, a level that runs out with its
root. Levers are moved for a while and rest for a while. Drives are late, have a dead zone or a play; machines stick,
leak or are biased; units are stated or 1; levers rest at zero or elsewhere; transducers have offsets and steps.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import sin, sqrt

import numpy as np
from numpy.typing import NDArray

from ident.run import Run

Array = NDArray[np.float64]
KINDS = ("boom", "motor", "spring", "arm", "level")
EXTRA = ("", "dead zone", "friction", "leak", "bias", "backlash")
_PARTS = 6  # steps of a sample
_STARTS = 6  # of the lever that is missing, while the other has come to rest: fewer show nothing


@dataclass(frozen=True)
class Levers:
    """One machine by its seed; `mean` is that of a turn of a lever, s, `lag` of the drive and `time` of the machine."""

    seed: int
    missing: bool
    kind: str
    extra: str
    rate: float
    seconds: float
    mean: float
    lag: float
    time: float
    unknown: bool
    level: float
    offset: float
    noise: float

    @classmethod
    def drawn(cls, seed: int, missing: bool) -> Levers:
        """A machine by its seed."""
        rng = np.random.default_rng([170, seed, missing])
        return cls(
            seed, missing, str(rng.choice(KINDS)), str(rng.choice(EXTRA)), float(rng.choice([20.0, 50.0, 100.0])),
            rng.uniform(100.0, 240.0), rng.uniform(1.0, 3.0), rng.uniform(0.02, 0.2), rng.uniform(0.05, 0.5),
            bool(rng.integers(3) == 0), float(rng.uniform(-2, 2) * (rng.random() < 0.3)),
            float(rng.uniform(-3, 3) * (rng.random() < 0.5)), rng.uniform(0.001, 0.01),
        )  # fmt: skip

    @cached_property
    def turns(self) -> tuple[Array, Array]:
        """What is recorded and what is not, both about zero; the other is there in both cases, and drives in one."""
        rng = np.random.default_rng([171, self.seed, self.missing])
        return self._lever(rng, bool(rng.integers(2))), rng.uniform(0.5, 1.0) * self._lever(rng, False)

    def _lever(self, rng: np.random.Generator, one_way: bool) -> Array:
        """Turns of half to twice the mean with ramps, and rests of 0.8 to 4 times the mean between them."""
        u, at = np.zeros(int(self.rate * self.seconds)), int(self.rate * rng.uniform(1.0, 3.0))
        while at < len(u):
            held = min(len(u) - at, int(self.rate * self.mean * rng.uniform(0.5, 2.0)))
            ramp, t = max(1.0, self.rate * rng.uniform(0.05, 0.3)), np.arange(1, held + 1)
            size = rng.uniform(0.4, 1.0) * (1.0 if one_way else rng.choice([-1.0, 1.0]))
            u[at : at + held] = size * np.minimum(1.0, np.minimum(t, held + 1 - t) / ramp)
            at += held + int(self.rate * self.mean * rng.uniform(0.8, 4.0))
        return u

    @property
    def shown(self) -> bool:
        """Whether the other lever sets out often enough while the recorded one rests and the machine has settled."""
        first, other = self.turns
        _, _, _, _, w, d = self._parts
        settle = int(self.rate * 4.0 * (self.lag + (1.0 / (w * d) if self.kind in ("spring", "arm") else self.time)))
        begins = np.flatnonzero((other[1:] != 0.0) & (other[:-1] == 0.0)) + 1
        calm = [k for k in begins if k > settle and not np.any(first[k - settle : k + settle])]
        calm = [k for k in calm if not np.any(other[k - settle : k])]
        return len(calm) >= _STARTS

    def run(self, use: str) -> Run:
        """The record."""
        rng = np.random.default_rng([172, self.seed, use == "verify"])
        first, other = self.turns
        y = self._moved(first + other if self.missing else first)
        y = y + y.std() * (self.offset + self.noise * rng.standard_normal(len(y)))
        step = np.ptp(y) / 2**12
        output = "velocity" if self.kind == "motor" else "displacement"
        unit = {"motor": "rad/s", "arm": "rad"}.get(self.kind, "m")
        units = {"command": "1" if self.unknown else "V", output: "1" if self.unknown else unit}
        return Run(
            use,
            "",
            self.rate,
            {"command": first + self.level, output: step * np.round(y / step)},
            units,
            output=output,
            use=use,
        )

    @cached_property
    def _parts(self) -> tuple[float, float, float, float, float, float]:
        """Delay in s, half of the dead zone and of the play, bias; of a spring or arm w in rad/s, and its damping."""
        rng = np.random.default_rng([173, self.seed])
        late, gap = rng.uniform(0.0, 0.2), rng.uniform(0.02, 0.15) * (self.extra == "dead zone")
        play = rng.uniform(0.02, 0.1) if self.extra == "backlash" else 0.0
        bias = rng.uniform(-0.1, 0.1) if self.extra == "bias" else 0.0
        return late, gap, play, bias, rng.uniform(1.0, 6.0), rng.uniform(0.2, 0.9)

    def _moved(self, drive: Array) -> Array:
        late, gap, play, bias, w, d = self._parts
        behind = int(self.rate * late)
        drive = np.concatenate([np.zeros(behind), drive[: len(drive) - behind]])
        drive = drive - np.clip(drive, -gap, gap)
        drive = _played(drive, play) if play else drive
        return self._integrated(drive + bias, w, d)

    def _integrated(self, drive: Array, w: float, d: float) -> Array:
        """Plain steps of Euler's method, the speed first; dry friction stops what is slower than it takes in a step."""
        h, q, x, v = 1.0 / self.rate / _PARTS, 0.0, 4.0 if self.kind == "level" else 0.0, 0.0
        dry, leak = 0.06 * (self.extra == "friction"), 0.05 * (self.extra == "leak")
        shown = np.empty(len(drive))
        for k, u in enumerate(drive.tolist()):
            shown[k] = v if self.kind == "motor" else x
            for _ in range(_PARTS):
                q += h * (u - q) / self.lag
                if self.kind == "boom":
                    x += h * (q - leak * x)
                elif self.kind == "level":
                    x = max(x + h * (1.0 + 0.9 * q - 0.5 * sqrt(x)) / (4.0 * self.time), 0.0)
                elif self.kind == "motor":
                    v = _slid(v + h * (q - v * (1.0 + leak)) / self.time, h * dry / self.time)
                else:
                    back = 1.5 * sin(x) if self.kind == "arm" else x
                    v = _slid(v + h * (w * w * (q - back) - 2 * d * w * v), h * w * w * dry)
                    x += h * v
        return shown


def _slid(v: float, stop: float) -> float:
    return v - stop if v > stop else v + stop if v < -stop else 0.0


def _played(drive: Array, half: float) -> Array:
    held, out = 0.0, []
    for u in drive.tolist():
        held = min(max(held, u - half), u + half)
        out.append(held)
    return np.array(out)

"""Machines of a lab, drawn at random and simulated here by recursions of their own: what records they leave.

Four structures, none of which shares a line with the program: a loop that follows its command like a lag, a position
loop of valve, oil and mass whose gain nobody stated, a valve that a command opens and whose cylinder integrates, and a
motor's speed. Commands of many kinds in V, mA or %, sampled at 20 Hz to 10 kHz by converters of 8 to 16 bits and clocks
that may jitter, with noise that is white or coloured, sensors that may drift, drives that may be disturbed, begun away
from zero; and, where one is hidden, an effect in its plainest form. Records are files, as a lab has them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray

from ident.matrix import Matrix
from ident.readers import read_matrix

Array = NDArray[np.float64]
STRUCTURES = ("lag", "loop", "cylinder", "motor")
HIDDEN: dict[str, tuple[str, ...]] = {
    "lag": ("command_delay", "command_limit"),
    "loop": ("dead_zone", "gain_asymmetry", "backlash"),
    "cylinder": ("dead_zone", "gain_asymmetry", "command_delay", "flow_saturation"),
    "motor": ("dead_zone", "coulomb_friction", "gain_asymmetry", "quadratic_damping"),
}
KINDS = ("noise", "steps", "staircase", "sweep", "by hand")
_PARTS = 40  # steps of a sample
_SAMPLES = 1500


@dataclass(frozen=True)
class Lab:
    """One machine and how it was recorded. `strength` is the hidden effect's share of the command's deviation.

    `jitter` is the largest deviation of a step of the clock, in steps; `drift` that of the sensor and `disturbance`
    that of the drive, in deviations of the noise.
    """

    seed: int
    structure: str
    kind: str
    hidden: str
    strength: float
    rate: float
    noise: float
    coloured: bool
    bits: int
    offset: float
    volts: float
    unit: str
    jitter: float
    drift: float
    disturbance: float

    @classmethod
    def drawn(cls, seed: int, hidden: bool) -> Lab:
        """A lab by its seed."""
        rng = np.random.default_rng([17, seed])
        structure = str(rng.choice(STRUCTURES))
        what = str(rng.choice(HIDDEN[structure])) if hidden else ""
        return cls(
            seed,
            structure,
            str(rng.choice(KINDS)),
            what,
            rng.uniform(0.4, 0.8),
            10 ** rng.uniform(1.3, 4.0),
            10 ** rng.uniform(-2.5, -1.7),
            bool(rng.integers(2)),
            int(rng.integers(8, 17)),
            rng.uniform(-1, 1) * rng.integers(2),
            10 ** rng.uniform(-1, 1.3),
            str(rng.choice(["V", "mA", "%"])),
            0.15 * (rng.integers(4) == 0),
            rng.uniform(0.5, 1.5) * (rng.integers(4) == 0),
            rng.uniform(0.5, 2.0) * (rng.integers(4) == 0),
        )

    def measured(self, noisy: bool = True) -> Matrix:
        """Two runs to fit and one to verify, read from files; without what disturbs and the converter the same."""
        with TemporaryDirectory() as folder:
            self.write(Path(folder), noisy)
            return read_matrix(Path(folder))

    def write(self, folder: Path, noisy: bool = True) -> None:
        """The records, and what the lab says of them."""
        runs: list[dict[str, Any]] = []
        output, unit = ("velocity", "rad/s") if self.structure == "motor" else ("displacement", "m")
        in_command = "m" if self.structure == "loop" else self.unit
        scale = 0.01 if self.structure == "loop" else self.volts
        for number, use in enumerate(("fit", "fit", "verify")):
            u = self._command(np.random.default_rng([self.seed, number]))
            random = np.random.default_rng([self.seed, number, 1])
            times = self._times(random, noisy)
            y = _MACHINES[self.structure](self, self.commanded(u, times) + self._disturbed(random, noisy))
            y = np.interp(times, np.arange(len(y)) / _PARTS, y)
            if noisy:
                beside = self._noise(random, len(y)) + self._drift(random, len(y))
                y = self._recorded(y + self.noise * y.std() * beside)
            table = np.column_stack([times / self.rate, scale * u, y])
            np.savetxt(folder / f"{number}.csv", table, delimiter=",", header="t,u,y", comments="", fmt="%.12g")
            hold = "zoh" if self.kind in ("steps", "staircase") else "linear"
            runs.append(
                {
                    "id": f"{use}-{number}",
                    "file": f"{number}.csv",
                    "time": {"column": "t", "unit": "s"},
                    "use": use,
                    "output": output,
                    "hold": hold,
                    "kind": "blwn" if self.kind == "noise" else "other",
                    "channels": {"command": {"column": "u", "unit": in_command}, output: {"column": "y", "unit": unit}},
                }
            )
        description = {"actuator": {"serial": f"LAB-{self.seed}"}, "runs": runs}
        (folder / "matrix.yaml").write_text(yaml.safe_dump(description))

    def _times(self, rng: np.random.Generator, noisy: bool) -> Array:
        """When the samples are taken, in steps of the clock."""
        stray = self.jitter * noisy * rng.uniform(-1, 1, _SAMPLES - 1)
        return np.concatenate([[0.0], np.cumsum(1.0 + stray)])

    def _disturbed(self, rng: np.random.Generator, noisy: bool) -> Array:
        """What comes to the drive beside the command, another for each sample."""
        n = self._last() * _PARTS
        return self.noise * self.disturbance * noisy * np.repeat(rng.standard_normal(n // _PARTS), _PARTS)

    def _drift(self, rng: np.random.Generator, n: int) -> Array:
        """A slow curve of the sensor, of `drift` deviations of the noise."""
        t, first, second = np.linspace(0, 1, n), rng.uniform(-1, 1), rng.uniform(-1, 1)
        slow = first * t + second * np.sin(np.pi * t)
        return self.drift * (slow - slow.mean()) / slow.std()

    def _last(self) -> int:
        """Steps that the simulation takes: more than an uneven clock needs."""
        return _SAMPLES + int(0.1 * _SAMPLES * (self.jitter > 0))

    def _command(self, rng: np.random.Generator) -> Array:
        """About one in size, held at zero for the first sixteenth."""
        n, rest = _SAMPLES, _SAMPLES // 16
        t = np.arange(n - rest) / (n - rest)
        if self.kind == "noise":
            moved = _low_passed(rng.standard_normal(n - rest), 0.06)
        elif self.kind == "steps":
            moved = np.repeat(rng.uniform(-1.5, 1.5, 30), n // 30 + 1)[: n - rest]
        elif self.kind == "staircase":
            moved = np.repeat(1.5 * np.sin(np.linspace(0, 4 * np.pi, 30)), n // 30 + 1)[: n - rest]
        elif self.kind == "sweep":
            moved = 1.4 * np.sin(2 * np.pi * (1.0 * t + 25.0 * t**2))
        else:
            moved = np.interp(np.arange(n - rest), np.arange(0, n, 50), rng.uniform(-1.7, 1.7, len(range(0, n, 50))))
        return np.concatenate([np.zeros(rest), moved * np.minimum(1.0, np.arange(len(moved)) / 4)])

    def _noise(self, rng: np.random.Generator, n: int) -> Array:
        white = rng.standard_normal(n)
        if self.coloured:
            for k in range(1, n):
                white[k] += 0.6 * white[k - 1]
        return white / white.std()

    def _recorded(self, y: Array) -> Array:
        step = 1.1 * float(np.ptp(y)) / 2**self.bits
        return np.round(y / step) * step

    def acts(self, u: Array) -> Array:
        """What of a drive signal reaches the flow, by what is hidden at the spool."""
        s = self.strength
        if self.hidden == "dead_zone":
            return np.sign(u) * np.maximum(np.abs(u) - 0.6 * s, 0.0)
        if self.hidden == "gain_asymmetry":
            return np.where(u > 0, (1 + 0.6 * s) * u, (1 - 0.6 * s) * u)
        if self.hidden == "command_limit":
            return np.clip(u, -1.4 + s, 1.4 - s)
        if self.hidden == "flow_saturation":
            return u / np.sqrt(1 + (1.2 * s * u) ** 2)
        return u

    def commanded(self, u: Array, times: Array) -> Array:
        """The command in the middle of every step of every sample, late where that is hidden."""
        fine = (np.arange(self._last() * _PARTS) + 0.5) / _PARTS
        if self.hidden == "command_delay":
            fine = np.maximum(fine - 6.0 * self.strength, 0.0)
        if self.kind in ("steps", "staircase"):
            return u[np.searchsorted(times, fine, side="right") - 1]
        return np.interp(fine, times, u)


def _low_passed(x: Array, share: float) -> Array:
    spectrum = np.fft.rfft(x)
    spectrum[np.fft.rfftfreq(len(x)) > share / 2] = 0.0
    found = np.fft.irfft(spectrum, len(x))
    return found / found.std()


def _lag(lab: Lab, fine: Array) -> Array:
    """T y' + y = u, T of eight samples."""
    acting, share, y, out = lab.acts(fine), -np.expm1(-1.0 / _PARTS / 8.0), 0.0, []
    for now in acting:
        out.append(y)
        y += share * (now - y)
    return 0.02 * np.array(out)


def _loop(lab: Lab, fine: Array) -> Array:
    """Gain into a valve's lag, an integrating cylinder on a spring of oil with its mass; in samples."""
    dt, play = 1.0 / _PARTS, lab.hidden == "backlash"
    half, zone, turn, held, out = 0.25 * lab.strength, 0.0, 0.0, 0.0, []
    if lab.hidden == "dead_zone":
        zone = 0.6 * lab.strength
    elif lab.hidden == "gain_asymmetry":
        turn = 0.6 * lab.strength

    def rates(now: float, q: float, p: float, v: float, x: float) -> tuple[float, float, float, float]:
        if play:
            w = held
        else:  # as `acts`, of one number
            u = 2.0 * q
            w = math.copysign(max(abs(u) - zone, 0.0), u) * (1 + turn if u > 0 else 1 - turn) / 2.0
        return (now - x - q) / 1.5, (0.12 * w - v - 0.02 * p) * 1.2, p - 0.5 * v, v

    q = p = v = x = 0.0
    for now in fine.tolist():
        out.append(x)
        if play:
            held = min(max(held, q - half), q + half)
        a, b, c, d = rates(now, q, p, v, x)
        a, b, c, d = rates(now, q + 0.5 * dt * a, p + 0.5 * dt * b, v + 0.5 * dt * c, x + 0.5 * dt * d)
        q, p, v, x = q + dt * a, p + dt * b, v + dt * c, x + dt * d  # the midpoint rule
    return 0.01 * np.array(out)


def _cylinder(lab: Lab, fine: Array) -> Array:
    """A valve's lag of five samples, and what it lets through integrated."""
    acting, dt, q, x, out = lab.acts(fine), 1.0 / _PARTS, 0.0, 0.0, []
    share = -np.expm1(-dt / 5.0)
    for now in acting:
        out.append(x)
        x += dt * now + 5.0 * share * (q - now)
        q += share * (now - q)
    return 1e-4 * np.array(out) + 0.3 * lab.offset


def _motor(lab: Lab, fine: Array) -> Array:
    """A voltage against inertia, damping, and what friction is hidden."""
    acting, share, w, out = lab.acts(fine), -np.expm1(-1.0 / _PARTS / 12.0), 0.0, []
    dry = 0.4 * lab.strength if lab.hidden == "coulomb_friction" else 0.0
    drag = 1.2 * lab.strength if lab.hidden == "quadratic_damping" else 0.0
    for now in acting:
        out.append(w)
        after = w + share * (now - w - drag * w * abs(w))
        stop = share * dry
        w = after - stop if after > stop else after + stop if after < -stop else 0.0
    return 30.0 * np.array(out)


_MACHINES: dict[str, Callable[[Lab, Array], Array]] = {
    "lag": _lag,
    "loop": _loop,
    "cylinder": _cylinder,
    "motor": _motor,
}


def sound(lab: Lab) -> Lab:
    """The same lab with nothing hidden."""
    return replace(lab, hidden="")

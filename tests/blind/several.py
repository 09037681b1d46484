"""Machines that lack one or two effects at once, by a simulation of their own: which machine is taken, what is named.

python -m tests.blind.several 0 24 [--seconds N]    seeds; six kinds in turn

The other trials hide one effect, and real machines seldom lack but one. A motor's speed, its angle, the angle of a link
behind a spring, a position loop around a motor, a lag, and a mass on a spring are simulated in 30 parts of a sample:
T ω' = a − ω − d ω|ω| − k (θ − θ₁) − s θ − k₃ θ³ − friction. Two runs to fit and one to verify; commands in V, % or 1.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import yaml
from numpy.typing import NDArray

from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.readers import read_matrix
from ident.workflows import diagnose, identify
from tests.blind.interval import rate

Array = NDArray[np.float64]
_PARTS, _SAMPLES = 30, 1800
EFFECTS: dict[str, tuple[str, ...]] = {
    "speed": ("dead zone", "dry friction", "delay", "asymmetry", "limit", "drag"),
    "angle": ("dead zone", "dry friction", "delay", "asymmetry", "limit"),
    "link": ("dead zone", "dry friction", "delay"),
    "servo": ("limit", "delay", "dead zone"),
    "lag": ("delay", "limit", "asymmetry"),
    "sprung": ("cubic spring", "dry friction", "delay", "second mass"),
}
"""By the kind of machine."""
STATIC = ("dead zone", "asymmetry", "limit")
"""What a command of two levels does not show."""
MACHINES: dict[str, tuple[str, ...]] = {
    "speed": ("motor", "first_order", "drive"),
    "angle": ("motor",),
    "link": ("motor",),
    "servo": ("position_servo", "qian2014"),
    "lag": ("first_order",),
    "sprung": ("drive", "sprung_motor"),
}
"""The models that are right for a kind."""
NAMES: dict[str, tuple[str, ...]] = {
    "dead zone": ("dead_zone",),
    "dry friction": ("coulomb_friction", "presliding_friction", "stribeck_friction"),
    "delay": ("command_delay", "loop_delay", "sensor_lag", "acquisition_lag"),
    "asymmetry": ("gain_asymmetry", "speed_asymmetry", "unequal_areas"),
    "limit": ("command_limit", "flow_saturation"),
    "drag": ("quadratic_damping",),
    "cubic spring": ("cubic_stiffness",),
    "second mass": ("elastic_load", "elastic_coupling"),
    "spring": ("elastic_load", "elastic_coupling"),
}
"""The names in the library that are right for what is hidden; the spring is that of a link."""


@dataclass(frozen=True)
class Several:
    """A machine and its test. `slow` (samples) is how long it takes to answer, `strength` that of all effects."""

    seed: int
    kind: str
    hidden: tuple[str, ...]
    command: str
    slow: float
    strength: float
    rate: float
    noise: float
    unit: str

    @classmethod
    def drawn(cls, seed: int) -> Several:
        """A machine by its seed."""
        rng, kind = np.random.default_rng([881, seed]), tuple(EFFECTS)[seed % len(EFFECTS)]
        command = str(rng.choice(["steps", "two levels", "sweep", "sines", "ramps"]))
        shown = [name for name in EFFECTS[kind] if not (command == "two levels" and name in STATIC)]
        hidden = rng.choice(shown, min(int(rng.integers(1, 3)), len(shown)), replace=False)
        return cls(
            seed,
            kind,
            tuple(map(str, hidden)),
            command,
            rng.uniform(10, 40),
            rng.uniform(0.5, 1.0),
            10 ** rng.uniform(1.5, 3.0),
            10 ** rng.uniform(-2.7, -1.7),
            str(rng.choice(["V", "1", "%"])),
        )

    @property
    def truth(self) -> tuple[str, ...]:
        """What has to be named."""
        return (*self.hidden, "spring") if self.kind == "link" else self.hidden

    @property
    def is_held(self) -> bool:
        """Whether the command keeps its value for a sample; else it goes straight to the next one."""
        return self.command in ("steps", "two levels")

    def measured(self) -> Matrix:
        """Its records, read from files."""
        with TemporaryDirectory() as folder:
            self.write(Path(folder))
            return read_matrix(Path(folder))

    def write(self, folder: Path) -> None:
        """The records, and what is said of them."""
        rng, runs = np.random.default_rng([882, self.seed]), []
        output, unit = {
            "speed": ("velocity", "rad/s"),
            "lag": ("displacement", "1"),
            "servo": ("displacement", "deg"),
        }.get(self.kind, ("displacement", "rad"))
        for number, use in enumerate(("fit", "fit", "verify")):
            u = self._commanded(rng)
            y = self.answer(u)
            y = y + self.noise * y.std() * rng.standard_normal(len(y))
            step = float(np.ptp(y)) / 4096
            table = np.column_stack([u, np.round(y / step) * step])
            np.savetxt(folder / f"{number}.csv", table, delimiter=",", header="u,y", comments="", fmt="%.9g")
            runs.append({
                "id": f"r{number}", "file": f"{number}.csv", "sample_rate": f"{self.rate:.6g} Hz", "use": use,
                "output": output, "kind": "other", "hold": "zoh" if self.is_held else "linear",
                "channels": {"command": {"column": "u", "unit": "deg" if self.kind == "servo" else self.unit},
                             output: {"column": "y", "unit": unit}},
            })  # fmt: skip
        described = {"actuator": {"serial": f"SEVERAL-{self.seed}"}, "runs": runs}
        (folder / "matrix.yaml").write_text(yaml.safe_dump(described))

    def _commanded(self, rng: np.random.Generator) -> Array:
        """About one in size, of a loop as many samples; zero for the first 25th."""
        t = np.arange(_SAMPLES)
        if self.command in ("steps", "two levels"):
            length = (
                int(rng.uniform(3, 6) * self.slow) if self.command == "steps" else int(rng.uniform(1, 2.5) * self.slow)
            )
            count = _SAMPLES // length + 1
            levels = rng.uniform(-1.5, 1.5, count) if self.command == "steps" else rng.choice([-1.0, 1.0], count)
            u = np.repeat(levels, length)[:_SAMPLES]
        elif self.command == "sweep":
            first, last = 0.02 / self.slow, 0.5 / self.slow
            u = 1.3 * np.sin(2 * np.pi * (first * t + (last - first) * t**2 / (2 * _SAMPLES)))
        elif self.command == "sines":
            u = sum(np.sin(2 * np.pi * f / self.slow * t + rng.uniform(0, 6.28)) for f in np.linspace(0.02, 0.5, 12))
            u = np.asarray(u) / np.std(u)
        else:
            places = np.arange(0, _SAMPLES, int(2 * self.slow))
            u = np.interp(t, places, rng.uniform(-1.6, 1.6, len(places)))
        u[: _SAMPLES // 25] = 0.0
        return np.asarray(u) * (self.slow if self.kind == "servo" else 1.0)

    def _of(self, name: str, size: float) -> float:
        """The strength of an effect, 0 where it is not hidden."""
        return size * self.strength if name in self.hidden else 0.0

    def answer(self, command: Array) -> Array:
        """The output without noise, at each sample, from rest."""
        s, kind, step = self.slow, self.kind, 1.0 / _PARTS
        fine = (
            np.arange(_SAMPLES * _PARTS) * step
            + 0.5 * step
            - self._of("delay", (0.12 if kind == "servo" else 0.25) * s)
        )
        times = np.arange(_SAMPLES)
        late = np.interp(fine, times, command)
        if self.is_held:
            late = command[np.clip(np.floor(fine).astype(int), 0, _SAMPLES - 1)]
        late = np.where(fine < 0, command[0], late)
        zone = self._of("dead zone", 0.2 if kind == "servo" else 0.35)
        most = 0.75 if "limit" in self.hidden else np.inf
        more = self._of("asymmetry", 0.3)
        friction, drag = self._of("dry friction", 0.3), self._of("drag", 0.8)
        constant = {"servo": 0.3}.get(kind, 1.0) * s
        swing = 2.6 / s
        mass, has_load = 0.4 * constant, kind == "link" or "second mass" in self.hidden
        spring = mass * swing**2 if has_load else 0.0
        stays = 2.9 / s if kind == "sprung" else 0.0
        cubic = self._of("cubic spring", 0.5) * stays * (2.9 / s) ** 2
        inertia, gain = constant, 3.0 / s if kind == "servo" else 0.0
        speed = angle = turning = load = lag = 0.0
        out = []
        for k, u in enumerate(late.tolist()):
            if k % _PARTS == 0:
                out.append({"speed": speed, "lag": lag, "link": load}.get(kind, angle))
            a = gain * (u - angle) if gain else u
            a = max(abs(a) - zone, 0.0) * (1.0 if a > 0 else -1.0) if zone else a
            a = min(max(a * (1.0 + more if a > 0 else 1.0 - more), -most), most)
            if kind == "lag":
                lag += step / constant * (a - lag)
                continue
            rate = a - speed - drag * speed * abs(speed) - spring * (angle - load) - stays * angle - cubic * angle**3
            free, stop = speed + step / inertia * rate, step / inertia * friction
            speed = free - stop if free > stop else free + stop if free < -stop else 0.0
            angle += step * speed
            if has_load:
                turning += step * (swing**2 * (angle - load) - 0.12 * swing * (turning - speed))
                load += step * turning
        return np.array(out)


@dataclass(frozen=True)
class Outcome:
    """What came of a trial; `groups` are the names of the verdict, each with those that cannot be told from it."""

    of: Several
    model: str
    errors: tuple[float, float]
    groups: tuple[frozenset[str], ...]
    standing: str | None

    @property
    def structure_right(self) -> bool:
        """Whether the machine is one of its kind."""
        return self.model in MACHINES[self.of.kind]

    @property
    def found(self) -> tuple[str, ...]:
        """What is hidden and named."""
        return tuple(name for name in self.of.truth if any({*NAMES[name]} & group for group in self.groups))

    @property
    def wrong(self) -> tuple[str, ...]:
        """Names for nothing that is hidden."""
        right = {name for hidden in self.of.truth for name in NAMES[hidden]}
        return tuple("/".join(sorted(group)) for group in self.groups if not group & right)

    def __str__(self) -> str:
        of = self.of
        before, after = (error / of.noise for error in self.errors)
        return (
            f"{of.seed} {of.kind} {of.command} {of.unit}: {', '.join(of.truth)}; {self.model} "
            f"{'right' if self.structure_right else 'wrong'}, {before:.3g} → {after:.3g} × noise, "
            f"named {', '.join(self.found) or 'none'}; wrong {', '.join(self.wrong) or 'none'}; {self.standing}"
        )


def trial(seed: int, seconds: float | None = None) -> Outcome:
    """A machine by its seed, diagnosed in so many seconds at most."""
    of = Several.drawn(seed)
    matrix = of.measured()
    fit = identify(matrix, Settings(model=""))
    found = diagnose(matrix, fit, seconds=seconds, propose=False)
    last = found.ladder[-1].error if found.ladder else fit.error
    alike = found.verdict.indistinguishable
    groups = (
        next((frozenset(group) for group in alike if name in group), frozenset({name}))
        for name in found.verdict.effects
    )
    return Outcome(of, fit.model, (fit.error["fit"] or 0.0, last["fit"] or 0.0), tuple(groups), found.verdict.standing)


def rates(outcomes: list[Outcome]) -> str:
    """How often each thing was right, as counts with 95 % intervals."""
    asked = {
        "structure right": [one.structure_right for one in outcomes],
        "all that is hidden named": [len(one.found) == len(one.of.truth) for one in outcomes],
        "nothing wrong named": [not one.wrong for one in outcomes],
    }
    return "; ".join(f"{what} {rate(right)}" for what, right in asked.items())


def main() -> None:
    """Trials one after the other."""
    parser = argparse.ArgumentParser()
    parser.add_argument("first", type=int)
    parser.add_argument("end", type=int)
    parser.add_argument("--seconds", type=float, default=120.0)
    asked, outcomes = parser.parse_args(), []
    for seed in range(asked.first, asked.end):
        outcomes.append(trial(seed, asked.seconds))
        print(outcomes[-1], flush=True)
    print(rates(outcomes))


if __name__ == "__main__":
    main()

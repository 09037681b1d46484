"""Machines of many kinds and how a lab records them, drawn at random: equations from the physics, integrated by SciPy.

Motors by voltage, their speed or their place; masses and inertias by a force or a torque; specimens that are moved; two
tanks that run out with a root; counters without direction; masses behind a spring; arms. Commands are held, straight
between the samples or band-limited, about zero or about an operating point; units are stated or 1; transducers have
offsets. What is hidden is one effect in its plainest form. Nothing of the program's library makes the data.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import sin, sqrt, tanh
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import odeint

from ident.matrix import Actuator, Matrix
from ident.readers import from_arrays
from ident.run import Run

Array = NDArray[np.float64]
Rates = Callable[[tuple[float, ...], float], tuple[float, ...]]
RATE, COUNT = 100.0, 600  # Hz and samples of a run
_FINE = 32  # parts of a sample in which a band-limited command is straight
_STEEP = 1e-4  # of a machine's usual speed: of what slides more slowly dry friction is less, so slowly it creeps

KINDS: dict[str, tuple[str, str, str, str, tuple[str, ...]]] = {
    "motor": ("V", "velocity", "rad/s", "motor", ("coulomb_friction", "quadratic_damping", "dead_zone")),
    "positioner": ("V", "displacement", "rad", "motor", ("coulomb_friction", "static_load", "dead_zone")),
    "mass": ("N", "displacement", "m", "drive", ("cubic_stiffness", "coulomb_friction", "quadratic_damping")),
    "inertia": ("N*m", "velocity", "rad/s", "drive", ("coulomb_friction", "quadratic_damping")),
    "specimen": ("m", "force", "N", "specimen", ("specimen_hysteresis", "cubic_stiffness", "coulomb_friction")),
    "tanks": ("V", "displacement", "m", "two_tanks", ("overflow", "sensor_curve")),
    "counter": ("V", "velocity", "rad/s", "motor", ("rectified_sensor",)),
    "coupled": ("V", "velocity", "rad/s", "motor", ("elastic_load", "elastic_coupling")),
    "arm": ("N*m", "displacement", "rad", "drive", ("arm_gravity", "coulomb_friction")),
}
"""Of each machine the unit of its command, its output and the unit of that, its model, and what may be hidden."""


@dataclass(frozen=True)
class Various:
    """One machine and how it was recorded.

    `hidden` acts with `strength` (0 to 1, of what would rule the machine); `quick` is in radians a sample, `noise` and
    `offset` in deviations of the output, the offset of that of the first run, `level` the operating point in deviations
    of the command.
    """

    seed: int
    kind: str
    hidden: str
    strength: float
    quick: float
    damping: float
    hold: str
    unknown: bool
    noise: float
    offset: float
    level: float

    @classmethod
    def drawn(cls, seed: int, hidden: bool) -> Various:
        """A machine by its seed."""
        rng = np.random.default_rng([168, seed])
        kind = str(rng.choice(list(KINDS)))
        what = str(rng.choice(KINDS[kind][4])) if hidden else ""
        hold = str(rng.choice(["zoh", "linear", "band-limited"]))
        free = kind in ("motor", "mass", "inertia", "coupled")
        return cls(
            seed,
            kind,
            what,
            rng.uniform(0.4, 0.9),
            rng.uniform(0.08, 0.25),
            rng.uniform(0.1, 0.6),
            "band-limited" if kind == "specimen" else hold,
            bool(rng.integers(3) == 0),
            10 ** rng.uniform(-2.6, -1.9),
            float(rng.uniform(-1, 1) * (rng.random() < 0.5) * (kind not in ("counter", "tanks"))),
            float(rng.uniform(-1, 1) * (rng.random() < 0.3) * free),
        )

    def measured(self, noisy: bool = True) -> Matrix:
        """Two runs to fit and one to verify."""
        rngs = [np.random.default_rng([169, self.seed, number]) for number in range(3)]
        commands = [self.command(rng) for rng in rngs]
        clean = [self.answered(u) for u in commands]
        runs = []
        for number, (rng, u, y) in enumerate(zip(rngs, commands, clean, strict=True)):
            off = self.offset * clean[0].std()  # one transducer
            seen = y + off + y.std() * self.noise * rng.standard_normal(len(y)) if noisy else y
            runs.append(self._run(number, ("fit", "fit", "verify")[number], u, seen))
        return Matrix(Actuator(f"V-{self.seed}"), tuple(runs))

    def _run(self, number: int, use: str, u: Array, y: Array) -> Run:
        of_command, output, of_output, _, _ = KINDS[self.kind]
        moved = "displacement" if self.kind == "specimen" else "command"
        units = {moved: "1", output: "1"} if self.unknown else {moved: of_command, output: of_output}
        stated: dict[str, Any] = {} if self.hold == "band-limited" else {"hold": self.hold}
        (run,) = from_arrays(
            {moved: u, output: y},
            units=units,
            output=output,
            sample_rate=f"{RATE} Hz",
            id=f"{use}-{number}",
            use=use,
            actuator={"serial": f"V-{self.seed}"},
            **stated,
        ).runs
        return run

    def command(self, rng: np.random.Generator) -> Array:
        """About one in size: levels that are held, straight lines, or lines of a band that repeats itself."""
        if self.hold == "band-limited":
            lines = np.fft.rfft(rng.standard_normal(COUNT))
            f = np.fft.rfftfreq(COUNT, 1.0)
            lines[(f > 2.5 * self.quick / (2 * np.pi)) | (f == 0)] = 0.0
            u = np.fft.irfft(lines, COUNT)
            u = u / u.std()
        else:
            dwell = int(rng.integers(8, 30))
            levels = rng.uniform(-1.7, 1.7, COUNT // dwell + 2)
            at = np.arange(COUNT)
            u = levels[at // dwell] if self.hold == "zoh" else np.interp(at / dwell, range(len(levels)), levels)
        if self.kind == "tanks":
            return np.asarray(3.0 + 0.8 * u).clip(0.3)
        return np.asarray(0.01 * u if self.kind == "specimen" else u + self.level)

    def answered(self, u: Array) -> Array:
        """What the machine shows of a command, without noise, an operating point first come to rest."""
        if self.kind == "specimen":
            return _pressed(self, u)
        rates, start, shown = _MACHINES[self.kind](self)
        fine = _fine(u, self.hold)
        inner = np.arange(len(fine)) / _FINE

        def slope(t: float, s: Array) -> tuple[float, ...]:
            return rates(
                tuple(s),
                float(fine[min(int(t * _FINE), len(fine) - 1)] if self.hold == "zoh" else np.interp(t, inner, fine)),
            )

        at = np.arange(len(u), dtype=float)
        found = odeint(slope, start, at, tfirst=True, hmax=0.5, rtol=1e-8, atol=1e-9, tcrit=at[1:-1], mxstep=5000)
        return np.array([shown(tuple(s)) for s in found])


def sound(of: Various) -> Various:
    """The same with nothing hidden."""
    return replace(of, hidden="")


def _fine(u: Array, hold: str) -> Array:
    """The command in parts of a sample; of a band that repeats itself exactly."""
    if hold == "band-limited":
        spectrum = np.fft.rfft(u)
        return np.asarray(np.fft.irfft(spectrum, _FINE * len(u)) * _FINE)
    if hold == "zoh":
        return np.repeat(u, _FINE)
    return np.asarray(np.interp(np.arange(_FINE * len(u)) / _FINE, np.arange(len(u)), u))


Parts = tuple[Rates, tuple[float, ...], Callable[[tuple[float, ...]], float]]


def _dry(of: Various, v: float, usual: float, most: float) -> float:
    return most * of.strength * tanh(v / (_STEEP * usual)) if of.hidden == "coulomb_friction" else 0.0


def _gap(of: Various, u: float) -> float:
    half = 0.5 * of.strength if of.hidden == "dead_zone" else 0.0
    return u - max(-half, min(half, u))


def _motor(of: Various) -> Parts:
    """T w' = u − w − dry − drag w |w|, in rad/s by 30; a counter shows the size alone."""
    drag = 1.5 * of.strength if of.hidden == "quadratic_damping" else 0.0

    def rates(s: tuple[float, ...], u: float) -> tuple[float, ...]:
        (w,) = s
        return (of.quick * (_gap(of, u) - w - drag * w * abs(w) - _dry(of, w, 1.0, 0.5)),)

    if of.hidden == "rectified_sensor":
        return rates, (0.0,), lambda s: 30.0 * abs(s[0])
    return rates, (of.level,), lambda s: 30.0 * s[0]


def _positioner(of: Various) -> Parts:
    """The same, its place: x' = w; a constant torque beside the voltage."""
    constant = 0.3 * of.strength if of.hidden == "static_load" else 0.0

    def rates(s: tuple[float, ...], u: float) -> tuple[float, ...]:
        _, w = s
        return w, of.quick * (_gap(of, u) - w - _dry(of, w, 1.0, 0.5) - constant)

    return rates, (0.0, 0.0), lambda s: 0.3 * s[0]


def _mass(of: Various) -> Parts:
    """x'' = W² (u − x − cube x³ − dry) − 2 D W v − drag v |v|, in m by 0.01."""
    w, d = of.quick, of.damping
    cube = 1.0 * of.strength if of.hidden == "cubic_stiffness" else 0.0
    drag = 3.0 * d * of.strength if of.hidden == "quadratic_damping" else 0.0

    def rates(s: tuple[float, ...], u: float) -> tuple[float, ...]:
        x, v = s
        return v, w * w * (u - x - cube * x**3 - _dry(of, v, w, 0.5)) - 2 * d * w * v - drag * v * abs(v)

    return rates, (of.level, 0.0), lambda s: 0.01 * s[0]


def _inertia(of: Various) -> Parts:
    """A torque on an inertia with a damper: the motor's equation, by 10."""
    rates, start, _ = _motor(of)
    return rates, start, lambda s: 10.0 * s[0]


def _tanks(of: Various) -> Parts:
    """h₁' = k u − c √h₁, h₂' = c √h₁ − c √h₂, in m; the lower one runs over at its rim; a gauge may bend."""
    c = of.quick
    rim = 9.0 + 0.6 * (1.0 - of.strength) if of.hidden == "overflow" else np.inf
    bend = 0.03 * of.strength if of.hidden == "sensor_curve" else 0.0

    def rates(s: tuple[float, ...], u: float) -> tuple[float, ...]:
        one, two = (max(h, 0.0) for h in s)
        through = c * sqrt(one)
        return c * u - through, through - c * sqrt(two) - 3.0 * c * max(two - rim, 0.0)

    return rates, (9.0, 9.0), lambda s: s[1] + bend * (s[1] - 9.0) ** 2


def _coupled(of: Various) -> Parts:
    """A share of the mass behind a spring; what is recorded is the drive's speed, or the load's."""
    share = 0.3 + 0.4 * of.strength if of.hidden else 0.0
    w, d = 2.5 * of.quick, 0.05 + 0.1 * of.damping
    free = 0.3 * of.quick

    def rates(s: tuple[float, ...], u: float) -> tuple[float, ...]:
        one, two, stretch = s
        if not share:
            return free * (u - one), 0.0, 0.0
        spring = share * (w * w * stretch + 2 * d * w * (one - two))
        return (free * (u - one) - spring) / (1 - share), spring / share, one - two

    shown = 1 if of.hidden == "elastic_coupling" else 0
    return rates, (of.level, of.level, 0.0), lambda s: 30.0 * s[shown]


def _arm(of: Various) -> Parts:
    """θ'' = torque − damper − a soft spring − the weight of the arm, which hangs at 0, in rad."""
    w, d = of.quick, of.damping
    weight = 2.0 * of.strength * w * w if of.hidden == "arm_gravity" else 0.0

    def rates(s: tuple[float, ...], u: float) -> tuple[float, ...]:
        x, v = s
        return v, w * w * (1.5 * u - x - 1.5 * _dry(of, v, w, 0.5)) - 2 * d * w * v - weight * sin(x)

    return rates, (0.0, 0.0), lambda s: s[0]


def _pressed(of: Various, x: Array) -> Array:
    """F = c v + k x + cube x³ + dry + yielding part, N, of a displacement (m) whose band repeats itself."""
    usual = float(np.std(x)) * of.quick
    fine = _fine(x, "band-limited")
    v = np.fft.irfft(np.fft.rfft(fine) * 2j * np.pi * np.fft.rfftfreq(len(fine), 1.0 / _FINE), len(fine))
    force = 3e4 * x + 2e4 * of.damping / of.quick * v[::_FINE]
    if of.hidden == "cubic_stiffness":
        force = force + 3e4 * of.strength * x**3 / np.var(x)
    if of.hidden == "coulomb_friction":
        force = force + 300.0 * of.strength * np.tanh(v[::_FINE] / (_STEEP * usual))
    if of.hidden == "specimen_hysteresis":
        z, width, held = 0.0, 0.4 * float(np.std(x)), []
        for k in range(len(fine)):
            if k % _FINE == 0:
                held.append(z)
            z += v[k] / _FINE / width * (1.0 - 0.5 * abs(z) * (abs(z) + z * np.sign(v[k])))
        force = force + 500.0 * of.strength * np.array(held)
    return np.asarray(force)


_MACHINES: dict[str, Callable[[Various], Parts]] = {
    "motor": _motor,
    "positioner": _positioner,
    "mass": _mass,
    "inertia": _inertia,
    "tanks": _tanks,
    "counter": _motor,
    "coupled": _coupled,
    "arm": _arm,
}

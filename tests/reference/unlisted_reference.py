"""The linear actuator with one of 24 effects that no list holds: a judge of the search for missing terms.

Kutta's classical rule with many sub-steps a sample; flat, SI, from rest; the command is straight between samples. Each
effect has a strength s, in shares of the sizes X, V0, P0, W0, Q0 = A V0 and F0 = A P0, and up to two shapes a and b;
pl(x, a) is a play of half-width a, sg(v) = tanh(v/Vs), he(x) = exp(-((x - a)/b)²).

    tau w' = Kp (u - y) - w                    y = x;        feedback_play  y = pl(x, s X) in the loop alone
    Q = Z0/A w (1 + ...)                       gain_hill  s he(x); speed_gain  s |v|/V0; warming_gain  s (1 - exp(-t/a));
                                               mass_gain  s mL/MS
        w + ...                                wide_opening  s max(w - a, 0); flow_hysteresis  s (pl(w, a) - w)
    Ka P' = Q - Cl P - A g v - Q0 s ...        square_leakage  P |P|/P0²; relief_valve  max(P - a, 0)/P0;
                                               late_leakage  z/P0, a z' = P - z; tilted_leakage  mL/MS P/P0
    (m0 + mL) v' = A g P - (c0 + cL) v - k x - F0 s ...
                                               cubic_damping  (v/V0)³; position_damping  (x/X)² v/V0;
                                               loaded_friction  |P|/P0 sg(v); bumper  max(x - a, 0)/X;
                                               yielding_element  (x - pl(x, a))/a; mount  (x - z)/X, z'' = a² (x - z) - b z';
                                               late_friction  z, a z' = sg(v) - z; pulsation  sin(2 pi (a t + b));
                                               running_in  exp(-t/a) sg(v); gain_friction  Kp/10 sg(v)
    g = 1 + ...                                tapered_piston  s x/X; bellows  s (x/X)²; breathing  s |P|/P0
"""  # noqa: E501

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from tests.reference import qian_reference as linear

Samples = NDArray[np.float64]
SUBSTEPS = 24
X, V0, VS, P0, W0, MS = 2e-3, 0.1, 2e-4, 1e6, 1e-2, 2.67

KINDS = {
    "one signal": ("square_leakage", "cubic_damping", "gain_hill"),
    "two signals": ("position_damping", "speed_gain", "loaded_friction"),
    "threshold": ("relief_valve", "bumper", "wide_opening"),
    "memory": ("feedback_play", "yielding_element", "flow_hysteresis"),
    "state": ("late_leakage", "mount", "late_friction"),
    "time": ("pulsation", "warming_gain", "running_in"),
    "condition": ("mass_gain", "gain_friction", "tilted_leakage"),
    "two places": ("tapered_piston", "bellows", "breathing"),
}
NAMES = tuple(name for names in KINDS.values() for name in names)
(
    SQUARE_LEAKAGE,
    CUBIC_DAMPING,
    GAIN_HILL,
    POSITION_DAMPING,
    SPEED_GAIN,
    LOADED_FRICTION,
    RELIEF_VALVE,
    BUMPER,
    WIDE_OPENING,
    FEEDBACK_PLAY,
    YIELDING_ELEMENT,
    FLOW_HYSTERESIS,
    LATE_LEAKAGE,
    MOUNT,
    LATE_FRICTION,
    PULSATION,
    WARMING_GAIN,
    RUNNING_IN,
    MASS_GAIN,
    GAIN_FRICTION,
    TILTED_LEAKAGE,
    TAPERED_PISTON,
    BELLOWS,
    BREATHING,
) = range(24)

SHAPES: dict[str, tuple[tuple[float, float], ...]] = {
    "gain_hill": ((-0.6 * X, 0.6 * X), (0.25 * X, 0.6 * X)),
    "relief_valve": ((0.1 * P0, 0.4 * P0),),
    "bumper": ((0.1 * X, 0.6 * X),),
    "wide_opening": ((0.1 * W0, 0.6 * W0),),
    "yielding_element": ((0.05 * X, 0.3 * X),),
    "flow_hysteresis": ((0.05 * W0, 0.2 * W0),),
    "late_leakage": ((3e-3, 20e-3),),
    "mount": ((2 * np.pi * 20, 2 * np.pi * 50), (20.0, 60.0)),
    "late_friction": ((2e-3, 8e-3),),
    "pulsation": ((12.0, 60.0), (0.0, 1.0)),
    "warming_gain": ((0.1, 0.5),),
    "running_in": ((0.2, 0.6),),
}
"""Between what the shapes a and b are drawn, in SI."""
SIGNED = {
    "gain_hill",
    "speed_gain",
    "wide_opening",
    "warming_gain",
    "mass_gain",
    "tapered_piston",
    "bellows",
    "breathing",
}
"""Effects whose strength may be of either sign."""


class Hidden(NamedTuple):
    """An effect by its number in NAMES, its strength and its shapes."""

    kind: int
    s: float
    a: float = 1.0
    b: float = 1.0

    @property
    def name(self) -> str:
        """That of the effect."""
        return NAMES[self.kind]


def drawn(name: str, rng: np.random.Generator) -> Hidden:
    """An effect with shapes anywhere within their ranges, of strength one or minus one."""
    sign = float(rng.choice([-1.0, 1.0])) if name in SIGNED else 1.0
    return Hidden(NAMES.index(name), sign, *(float(rng.uniform(low, high)) for low, high in SHAPES.get(name, ())))


@njit(inline="always")
def held_signal(h, s):
    """What has a play, if anything has."""
    return s[0] if h.kind == FLOW_HYSTERESIS else s[3]


@njit(inline="always")
def play(h):
    """Its half-width."""
    return h.s * X if h.kind == FEEDBACK_PLAY else h.a


@njit(inline="always")
def flow(plant, cell, h, t, s, held):
    w, p, v, x = s[0], s[1], s[2], s[3]
    if h.kind == WIDE_OPENING:
        w += h.s * max(w - h.a, 0.0)
    elif h.kind == FLOW_HYSTERESIS:
        w += h.s * (held - w)
    elif h.kind == GAIN_HILL:
        w *= 1 + h.s * np.exp(-(((x - h.a) / h.b) ** 2))
    elif h.kind == SPEED_GAIN:
        w *= 1 + h.s * abs(v) / V0
    elif h.kind == WARMING_GAIN:
        w *= 1 + h.s * (1 - np.exp(-t / h.a))
    elif h.kind == MASS_GAIN:
        w *= 1 + h.s * cell.mass / MS
    leak = 0.0
    if h.kind == SQUARE_LEAKAGE:
        leak = p * abs(p) / P0**2
    elif h.kind == RELIEF_VALVE:
        leak = max(p - h.a, 0.0) / P0
    elif h.kind == LATE_LEAKAGE:
        leak = s[4] / P0
    elif h.kind == TILTED_LEAKAGE:
        leak = cell.mass / MS * p / P0
    return plant.Z0 / plant.A * w - plant.A * V0 * h.s * leak


@njit(inline="always")
def resistance(plant, cell, h, t, s, held):
    p, v, x, slip, force = s[1], s[2], s[3], np.tanh(s[2] / VS), 0.0
    if h.kind == CUBIC_DAMPING:
        force = (v / V0) ** 3
    elif h.kind == POSITION_DAMPING:
        force = (x / X) ** 2 * v / V0
    elif h.kind == LOADED_FRICTION:
        force = abs(p) / P0 * slip
    elif h.kind == BUMPER:
        force = max(x - h.a, 0.0) / X
    elif h.kind == YIELDING_ELEMENT:
        force = (x - held) / h.a
    elif h.kind == MOUNT:
        force = (x - s[4]) / X
    elif h.kind == LATE_FRICTION:
        force = s[4]
    elif h.kind == PULSATION:
        force = np.sin(2 * np.pi * (h.a * t + h.b))
    elif h.kind == RUNNING_IN:
        force = np.exp(-t / h.a) * slip
    elif h.kind == GAIN_FRICTION:
        force = cell.gain / 10.0 * slip
    return plant.A * P0 * h.s * force


@njit(inline="always")
def derivative(plant, cell, h, t, u, s, held, out):
    w, p, v, x = s[0], s[1], s[2], s[3]
    y = held if h.kind == FEEDBACK_PLAY else x
    area = plant.A
    if h.kind == TAPERED_PISTON:
        area *= 1 + h.s * x / X
    elif h.kind == BELLOWS:
        area *= 1 + h.s * (x / X) ** 2
    elif h.kind == BREATHING:
        area *= 1 + h.s * abs(p) / P0
    out[0] = (cell.gain * (u - y) - w) / plant.tau
    out[1] = (flow(plant, cell, h, t, s, held) - plant.Cl * p - area * v) / plant.Ka
    force = area * p - (plant.c0 + cell.damping) * v - cell.stiffness * x
    out[2] = (force - resistance(plant, cell, h, t, s, held)) / (plant.m0 + cell.mass)
    out[3] = v
    out[4], out[5] = 0.0, 0.0
    if h.kind == LATE_LEAKAGE:
        out[4] = (p - s[4]) / h.a
    elif h.kind == LATE_FRICTION:
        out[4] = (np.tanh(v / VS) - s[4]) / h.a
    elif h.kind == MOUNT:
        out[4], out[5] = s[5], h.a**2 * (x - s[4]) - h.b * s[5]


@njit(nogil=True, cache=True)
def integrate(plant, cell, h, command, rate):
    """Displacement (m), shape (n,), of one run; beyond any stroke it stays where it is."""
    s, trial, k = np.zeros(6), np.empty(6), np.empty((4, 6))
    out, held = np.zeros(len(command)), 0.0
    dt = 1 / (rate * SUBSTEPS)
    for n in range(len(command) - 1):
        out[n] = s[3]
        rise = command[n + 1] - command[n]
        for step in range(SUBSTEPS):
            t = n / rate + step * dt
            now = held_signal(h, s)
            held = min(max(held, now - play(h)), now + play(h))
            for stage in range(4):
                share = 0.0 if stage == 0 else (1.0 if stage == 3 else 0.5)
                for i in range(6):
                    trial[i] = s[i] + (share * dt * k[stage - 1, i] if stage else 0.0)
                u = command[n] + rise * (step + share) / SUBSTEPS
                derivative(plant, cell, h, t + share * dt, u, trial, held, k[stage])
            for i in range(6):
                s[i] += dt / 6 * (k[0, i] + 2 * k[1, i] + 2 * k[2, i] + k[3, i])
        if not abs(s[3]) < 1.0:
            out[n + 1 :] = 1.0
            return out
    out[-1] = s[3]
    return out


def measure_all(
    hidden: Hidden, runs: Sequence[linear.Trial], plant: linear.Plant, *, seconds: float, noise: float, seed: int
) -> list[linear.Record]:
    """Every run, each with its own command and noise, on all cores."""

    def one(numbered: tuple[int, linear.Trial]) -> linear.Record:
        number, trial = numbered
        rng = np.random.default_rng([seed, number])
        command = linear.band_limited_noise(round(seconds * linear.SAMPLE_RATE), trial.amplitude, rng)
        clean = integrate(plant, trial.cell, hidden, command, linear.SAMPLE_RATE)
        return linear.Record(trial, command, clean + noise * clean.std() * rng.standard_normal(len(clean)))

    with ThreadPoolExecutor() as pool:
        return list(pool.map(one, enumerate(runs)))

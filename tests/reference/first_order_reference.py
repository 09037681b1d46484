"""A closed loop that follows like a single lag, solved in closed form: an independent judge of tracking.

    tau y' + y = k r,   r(t) = sum of A sin(2 pi f t + phase)

The reference is continuous: nothing is held between samples and nothing is integrated in steps. For constant tau and k

    y(t) = p(t) + (y(t0) - p(t0)) exp(-(t - t0)/tau),
    p(t) = sum of k A / sqrt(1 + (w tau)^2) sin(w t + phase - atan(w tau)),   w = 2 pi f

and where tau or k steps, y goes on from where it was. A reference that is held between samples has the exact solution
y[n+1] = k r[n] + (y[n] - k r[n]) exp(-dt/tau). Everything is SI; nothing here comes from the program's library.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Samples = NDArray[np.float64]

SAMPLE_RATE = 4096.0  # Hz
SENSOR = 1.2e-4  # m, standard deviation: the position sensor of the hybrid-simulation paper
FREQUENCY, AMPLITUDE = 1.0, 0.05  # Hz and m: its test
TAUS, GAINS = (5e-3, 50e-3), (0.7, 1.2)  # s and 1: of drawn loops
OFF = 5.0  # times at most that a start is off


class Sine(NamedTuple):
    """A sin(2 pi f t + phase): m, Hz, rad."""

    amplitude: float = AMPLITUDE
    frequency: float = FREQUENCY
    phase: float = 0.0


class Loop(NamedTuple):
    """Constant parameters from the time `start` (s) on."""

    tau: float  # s
    gain: float
    start: float = 0.0


def reference(t: Samples, sines: Sequence[Sine] = (Sine(),)) -> Samples:
    """r at the times t."""
    return sum((a * np.sin(2 * np.pi * f * t + phase) for a, f, phase in sines), np.zeros_like(t))


def forced(t: Samples | float, loop: Loop, sines: Sequence[Sine]) -> Samples:
    """The particular solution p at the times t."""
    found = np.zeros_like(np.asarray(t, dtype=float))
    for amplitude, frequency, phase in sines:
        w = 2 * np.pi * frequency
        size = loop.gain * amplitude / np.hypot(1.0, w * loop.tau)
        found = found + size * np.sin(w * np.asarray(t) + phase - np.arctan(w * loop.tau))
    return found


def response(t: Samples, loops: Sequence[Loop], sines: Sequence[Sine] = (Sine(),)) -> Samples:
    """y at the times t, at rest when the first loop starts."""
    y, value = np.zeros_like(t), 0.0
    ends = [*(loop.start for loop in loops[1:]), np.inf]
    for loop, end in zip(loops, ends, strict=True):
        missing = value - float(forced(loop.start, loop, sines))
        inside = (t >= loop.start) & (t < end)
        y[inside] = forced(t[inside], loop, sines) + missing * np.exp(-(t[inside] - loop.start) / loop.tau)
        if np.isfinite(end):
            value = float(forced(end, loop, sines)) + missing * np.exp(-(end - loop.start) / loop.tau)
    return y


def held(command: Samples, loop: Loop, sample_rate: float = SAMPLE_RATE) -> Samples:
    """y at the samples where each command is held until the next, from rest."""
    decay, y = np.exp(-1.0 / (sample_rate * loop.tau)), np.zeros(len(command))
    for n in range(len(command) - 1):
        y[n + 1] = loop.gain * command[n] + (y[n] - loop.gain * command[n]) * decay
    return y


def times(seconds: float, sample_rate: float = SAMPLE_RATE) -> Samples:
    """The times of the samples."""
    return np.arange(round(seconds * sample_rate)) / sample_rate


class Trial(NamedTuple):
    """One drawn loop, where a filter starts, and what it is given."""

    loop: Loop
    tau0: float
    gain0: float
    r: Samples
    y: Samples


def trial(seed: int, seconds: float) -> Trial:
    """tau uniform in its logarithm over 5 to 50 ms, k over 0.7 to 1.2, starts off by up to five times, noise."""
    draw = np.random.default_rng(seed)
    loop = Loop(float(np.exp(draw.uniform(np.log(TAUS[0]), np.log(TAUS[1])))), float(draw.uniform(*GAINS)))
    off = OFF ** draw.uniform(-1, 1, 2)
    t = times(seconds)
    y = response(t, [loop]) + SENSOR * draw.standard_normal(len(t))
    return Trial(loop, loop.tau * off[0], loop.gain * off[1], reference(t), y)


class Rig(NamedTuple):
    """A hybrid simulation of one storey, part of it physical, behind a first-order actuator.

    The numerical part m, c, (1 - share) k is driven by the ground and by the force that the physical spring had at
    the last sample; what it moves by is wanted of the actuator, whose command is held between samples.
    """

    mass: float = 1000.0  # kg
    stiffness: float = 1e6  # N/m
    damping_ratio: float = 0.01
    share: float = 0.2  # of the stiffness that is physical
    actuator: Loop = Loop(20e-3, 1.0)


def hybrid(rig: Rig, ground: Samples, command: object, noise: Samples, largest: float = 1.0) -> tuple[Samples, Samples]:
    """d, the numerical displacement, and y, the measured one, to a ground acceleration (m/s^2) at the samples.

    `command(d, y)` gives what is sent to the actuator. Where d passes `largest` (m) the simulation ends, the rest NaN.
    """
    dt, parts = 1 / SAMPLE_RATE, 8
    c = 2 * rig.damping_ratio * np.sqrt(rig.mass * rig.stiffness)
    decay = np.exp(-dt / rig.actuator.tau)
    d_all, y_all = np.full(len(ground), np.nan), np.full(len(ground), np.nan)
    d = v = y = 0.0
    for n, acceleration in enumerate(ground):
        d_all[n], y_all[n] = d, y
        if abs(d) > largest:
            break
        u = command(d, y + noise[n])  # type: ignore[operator]
        force = rig.share * rig.stiffness * y
        for _ in range(parts):
            v += dt / parts * (-acceleration - (c * v + (1 - rig.share) * rig.stiffness * d + force) / rig.mass)
            d += dt / parts * v
        y = rig.actuator.gain * u + (y - rig.actuator.gain * u) * decay
    return d_all, y_all

"""Kononykhin's actuator on its bench, in one flat file: an independent judge of the procedures.

Blocks a to d by Heun's rule with sub-steps, the play and the friction as plain branches, the bench's laws as a
controller that works once a sample on the quantised position. Nothing here comes from the program's library.
Currents are in % of the rated one, lengths in mm, pressures in MPa; time in s.

    T I' + I = Iin;  play of half-width B;  V0 = G side(s) (I_BL - I0)/100 (1 + n - n |I_BL - I0|/100)
    V = V0 sqrt(1 - dPfr/available), available = min(kp |I_BL - I0|, Ps), 0 where it is less than dPfr
    pressure difference: at rest kp (I_BL - I0), moving +-dPfr

Hidden, where a truth has them: a delay of the current; a second lag T2 behind the first; stiction, the pressure above
dPfr that breaks the link loose; a spring of `load` MPa a mm from the middle of the stroke, added to what is needed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Samples = NDArray[np.float64]
RATE = 1000.0  # Hz
STROKE = 100.0  # mm
BITS = 12
PRESSURE_NOISE = 0.2  # MPa RMS, of each cavity
PRESSURE_RANGE = 25.0  # MPa, of a gauge's converter
SUBSTEPS = 32
FREQUENCIES = (0.2, 0.5, 1.0, 2.0, 5.0)  # Hz
AMPLITUDES = (2.0, 10.0, 50.0)  # %
LEVELS = (3.0, 6.0, 12.0, 25.0, 50.0, 75.0, 100.0)  # %
RANGES = ((15.0, 25.0), (45.0, 55.0), (75.0, 85.0))  # mm


class Truth(NamedTuple):
    """One actuator; `delay` and what follows it is what the model does not have."""

    T: float = 0.02
    B: float = 0.2
    I0: float = 0.0
    kp: float = 4.2
    dPfr: float = 0.5
    Ps: float = 21.0
    G: float = 100.0  # mm/s at rated current, the mean of both directions
    asymmetry: float = 0.1  # (forward - back) / mean
    nonlinearity: float = 0.05  # of full speed, against the chord
    delay: float = 0.0
    second_lag: float = 0.0
    stiction: float = 0.0  # MPa
    load: float = 0.0  # MPa/mm

    @property
    def dead_space(self) -> float:
        """Half of the range of currents in which the actuator stands."""
        return self.B + self.dPfr / self.kp

    def speed(self, u: Samples) -> Samples:
        """f without load and friction, mm/s, of a current from the zero shift, %."""
        side = 1.0 + 0.5 * self.asymmetry * np.sign(u)
        bend = 4.0 * self.nonlinearity
        return self.G * side * u / 100.0 * (1.0 + bend - bend * np.abs(u) / 100.0)


def scattered(seed: int) -> Truth:
    """An actuator about the middle: T and gain x 0.6-1.7, B x 1/3-3, a zero shift up to 2 %."""
    rng = np.random.default_rng([seed, 20190])
    stretch = np.exp(rng.uniform(np.log(0.6), np.log(1.7), 2))
    return Truth(
        T=0.02 * stretch[0], G=100.0 * stretch[1], B=0.2 * float(np.exp(rng.uniform(-np.log(3), np.log(3)))),
        I0=rng.uniform(-2.0, 2.0), kp=4.2 * rng.uniform(0.85, 1.15), dPfr=0.5 * rng.uniform(0.7, 1.4),
        asymmetry=0.1 * rng.choice([-1.0, 1.0]),
    )  # fmt: skip


class Instruments(NamedTuple):
    """What reads the bench: converters of so many bits over the stroke and the gauges' range, noise of each gauge."""

    bits: int = BITS
    pressure_noise: float = PRESSURE_NOISE  # MPa RMS
    pressure_bits: int = 0  # over PRESSURE_RANGE; 0 where the gauges are not converted in steps
    held: bool = False  # the current of a sample stays until the next one, else it is a straight line between them
    regulator: float = 1.0  # % of current a mm, of the static test
    anywhere: float = 0.0  # mm within which each record begins at random: where in a step of the converter is chance

    def position(self, x: Samples) -> Samples:
        """mm, in steps."""
        step = STROKE / 2**self.bits
        return np.round(x / step) * step

    def pressure(self, p: Samples) -> Samples:
        """MPa, in steps where there are any."""
        step = PRESSURE_RANGE / 2**self.pressure_bits
        return np.round(p / step) * step if self.pressure_bits else p


TABLE = Instruments()
"""The instruments of the table in docs/bench.md."""


@dataclass(frozen=True)
class Record:
    """One record of the bench and, beside what it recorded, the true position."""

    id: str
    kind: str
    current: Samples
    position: Samples  # quantised
    pressure_a: Samples
    pressure_b: Samples
    true_position: Samples
    frequency: float = 0.0
    amplitude: float = 0.0
    position_range: tuple[float, float] = (0.0, STROKE)


@njit(cache=True)
def _advance(state, i0, i1, dt, T, B, I0, kp, fr, Ps, G, asymmetry, bend, T2, stick, load, steps):
    """One sample of the actuator: state = lagged current, play, position, pressure, twice lagged current, moving."""
    h = dt / steps
    for k in range(steps):
        a = i0 + (i1 - i0) * k / steps
        b = i0 + (i1 - i0) * (k + 1) / steps
        slope = (a - state[0]) / T
        q = state[0] + 0.5 * h * (slope + (b - state[0] - h * slope) / T)
        q2 = q
        if T2 > 0.0:
            share = 1.0 - np.exp(-h / T2)
            q2 = state[4] + share * (0.5 * (state[0] + q) - state[4])
        for part in range(2):
            seen = 0.5 * (state[4] + q2) if part == 0 else q2
            if seen > state[1] + B:
                state[1] = seen - B
            if seen < state[1] - B:
                state[1] = seen + B
            if part == 1:
                break
            u = state[1] - I0
            available = min(kp * abs(u), Ps)
            needed = fr + np.sign(u) * load * (state[2] - 0.5 * STROKE)
            if available > needed + (0.0 if state[5] > 0.0 else stick):
                side = 1.0 + 0.5 * asymmetry * np.sign(u)
                v = G * side * u / 100.0 * (1.0 + bend - bend * abs(u) / 100.0)
                state[2] += h * v * np.sqrt(1.0 - needed / available)
                state[5] = 1.0
            else:
                state[5] = 0.0
        state[0] = q
        state[4] = q2
        u = state[1] - I0
        force = load * (state[2] - 0.5 * STROKE)
        state[3] = (
            np.sign(u) * fr + force if state[5] > 0.0 else min(max(kp * u, force - fr - stick), force + fr + stick)
        )


@njit(cache=True)
def _bench(
    law, settings, samples, dt, lsb, start, T, B, I0, kp, fr, Ps, G, asymmetry, bend, delay, T2, stick, load, steps,
    held,
):  # fmt: skip
    """A record under one of the bench's laws; the controller sees the quantised position of the sample before."""
    state = np.array([settings[0], 0.0, start, 0.0, settings[0], 0.0])
    state[1] = min(max(I0, state[0] - B), state[0] + B)
    current, x, p = np.empty(samples), np.empty(samples), np.empty(samples)
    old = settings[0]
    compensation, mean_before, total, count = 0.0, start, 0.0, 0
    direction, stroke_start = 1.0, start
    late = round(delay / dt)
    for k in range(samples):
        seen = np.round(state[2] / lsb) * lsb
        t = k * dt
        now = settings[0]
        if law == 0:  # saw-tooth of the set position: offset + gain (set - seen)
            offset, gain, rate, width = settings[0], settings[1], settings[2], settings[3]
            phase = (t * rate) % (4.0 * width)
            tooth = phase if phase < width else (2.0 * width - phase if phase < 3.0 * width else phase - 4.0 * width)
            now = offset + gain * (start + tooth - seen)
        elif law == 1:  # sine; the mean of each period is compared with that of the one before
            centre, size, frequency, gain = settings[0], settings[1], settings[2], settings[3]
            total, count = total + seen, count + 1
            if count == round(1.0 / frequency / dt):
                if t > 1.5 / frequency:
                    compensation += gain * (mean_before - total / count)
                mean_before, total, count = total / count, 0.0, 0
            now = centre + compensation + size * np.sin(2.0 * np.pi * frequency * t)
        elif law == 2:  # fixed levels, forth and back, a rest between them
            level, length, rest, slope = settings[1], settings[2], settings[3], settings[4]
            place = t % (2.0 * (length + rest))
            sign = 1.0 if place < length + rest else -1.0
            inside = place % (length + rest) < length
            wanted = settings[0] + (sign * level if inside else 0.0)
            most = slope * dt
            now = old + min(max(wanted - old, -most), most)
        elif law == 3:  # current in proportion to the position, up to the middle and down again, then back
            lowest, highest, travel = settings[1], settings[2], settings[3]
            done = abs(seen - stroke_start) / travel
            if done >= 0.97:
                direction, stroke_start, done = -direction, seen, 0.0
            share = min(2.0 * done, max(0.0, 2.0 - 2.0 * done))
            wanted = settings[0] + direction * (lowest + (highest - lowest) * share)
            most = settings[4] * dt
            now = old + min(max(wanted - old, -most), most)
        drive = now
        before = old
        if late > 0:
            drive = current[k - late] if k >= late else settings[0]
            before = current[k - late - 1] if k >= late + 1 else settings[0]
        if k > 0:
            _advance(state, before, before if held else drive, dt, T, B, I0, kp, fr, Ps, G, asymmetry, bend, T2, stick,
                     load, steps)  # fmt: skip
        current[k], x[k], p[k] = now, state[2], state[3]
        old = now
    return current, x, p


def record(truth: Truth, name: str, kind: str, law: int, settings: list[float], seconds: float, start: float,
           rng: np.random.Generator, read: Instruments = TABLE, **labels) -> Record:  # fmt: skip
    """Run the bench and add what its transducers make of it."""
    lsb = STROKE / 2**read.bits
    start += read.anywhere * rng.uniform() if read.anywhere else 0.0
    current, x, p = _bench(
        law, np.array([*settings, 0.0, 0.0, 0.0, 0.0][:6]), round(seconds * RATE), 1 / RATE, lsb, start, truth.T,
        truth.B, truth.I0, truth.kp, truth.dPfr, truth.Ps, truth.G, truth.asymmetry, 4 * truth.nonlinearity,
        truth.delay, truth.second_lag, truth.stiction, truth.load, SUBSTEPS, read.held,
    )  # fmt: skip
    noise = read.pressure_noise * rng.standard_normal((2, len(x)))
    a, b = 0.5 * (truth.Ps + p) + noise[0], 0.5 * (truth.Ps - p) + noise[1]
    return Record(name, kind, current, read.position(x), read.pressure(a), read.pressure(b), x, **labels)


def full_set(truth: Truth, seed: int, read: Instruments = TABLE, short: bool = False) -> list[Record]:
    """Every record that the procedures want; the bench knows the zero shift to half a per cent.

    `short` leaves out what takes longest: one range of positions, sines from 1 Hz on.
    """
    rng = np.random.default_rng([seed, 77])
    guess = truth.I0 + rng.uniform(-0.5, 0.5) if truth.I0 else 0.0
    out = []
    for low, high in RANGES[1:2] if short else RANGES:
        settings = [guess, read.regulator, 0.25, 1.5]  # offset %, gain %/mm, rate mm/s, width mm
        out.append(record(truth, f"static-{low:.0f}", "static", 0, settings, 48.0, 0.5 * (low + high), rng,
                          read, position_range=(low, high)))  # fmt: skip
    for amplitude in AMPLITUDES:
        for frequency in FREQUENCIES[2:] if short else FREQUENCIES:
            gain = 0.3 * frequency / truth.G * 100.0  # % of current a mm of drift from period to period
            out.append(record(
                truth, f"sine-{amplitude:g}-{frequency:g}", "frequency", 1, [guess, amplitude, frequency, gain],
                5.0 / frequency, 50.0, rng, read, frequency=frequency, amplitude=amplitude,
            ))  # fmt: skip
    for level in LEVELS:
        length = min(3.0, 60.0 / (1.3 * truth.G * level / 100.0))
        out.append(record(truth, f"level-{level:g}", "speed-levels", 2, [guess, level, length, 0.3, 2000.0],
                          2 * (length + 0.3), 20.0, rng, read))  # fmt: skip
    out.append(record(truth, "stroke", "speed-continuous", 3, [guess, 3.0, 100.0, 90.0, 400.0],
                      12.0 * 100.0 / truth.G, 5.0, rng, read))  # fmt: skip
    return out

"""An oscillation that a machine keeps up by itself: its output swings on, or ever farther, while every input rests.

What rings after a step dies down. What is swung by itself does not: y = a exp(σ t) sin(ω t + φ) with σ ≥ 0, up to the
size at which friction, a stop or a limit holds it. The phase and the logarithm of the size of y exp(−iω t), averaged
over whole periods, are straight lines in time, whose slopes are the error of ω and σ.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.checks.at_rest import acting, rests
from ident.noise.power_density import hann
from ident.run import BENCH, Run, Samples

PERIODS = 10  # of a stretch at least: fewer tell no growth
SAMPLES = 8  # a period at least
SIZE = 0.01  # of the output's range, that the amplitude has at least
SHARE = 0.5  # of the power that is as quick or quicker, that the oscillation has at least; and of it a smooth one
WIDTH = 3  # lines to either side of the largest that a Hann window spreads it over, and growth with it
DIES = 0.1  # logarithm of the amplitude lost over the stretch, beyond which it rings down
GROWS = 0.5  # logarithm of the amplitude gained over the stretch, below which it has settled
MAINS, NEAR = (50.0, 60.0), 0.003  # Hz, and the relative distance within which it may be picked up from them


@dataclass(frozen=True)
class AtRest:
    """A stretch in which the output swings while every input rests, `start` to `end` in s; Hz, and growth σ in 1/s.

    Where the run's time is in samples, all are by the sample.
    """

    start: float
    end: float
    frequency: float
    growth: float


def oscillation_at_rest(run: Run) -> AtRest | None:
    """The oscillation of the longest stretch that shows one while every input rests; None where none does."""
    inputs = acting(run)
    if run.kind in BENCH or not inputs:
        return None
    stretches = sorted(rests(inputs, PERIODS * SAMPLES), key=lambda one: one.start - one.stop)
    for stretch in stretches:
        y = run.measured[stretch]
        runs_on = abs(float(y.mean())) if run.output == "velocity" else 0.0  # a ripple of what turns is driven round
        found = _swings(y, max(SIZE * float(np.ptp(run.measured)), runs_on))
        if found is not None:
            frequency, growth = found[0] * run.sample_rate, found[1] * run.sample_rate
            if run.time_unit != "s" or not is_of_mains(frequency):
                return AtRest(stretch.start / run.sample_rate, stretch.stop / run.sample_rate, frequency, growth)
    return None


def is_of_mains(frequency: float) -> bool:
    """Whether an oscillation, Hz, may be picked up from the mains."""
    return any(abs(frequency - mains) <= NEAR * mains for mains in MAINS)


def _swings(y: Samples, least: float) -> tuple[float, float] | None:
    """The frequency of what swings in a stretch, and its growth, both per sample.

    None where it dies down, or nothing swings by as much as `least`.
    """
    n = len(y)
    k = np.arange(n)
    y = y - np.polyval(np.polyfit(k, y, 1), k)
    power = np.abs(np.fft.rfft(y * hann(n))) ** 2
    power[: PERIODS - WIDTH] = 0.0
    top = int(np.argmax(power))
    peak = slice(max(top - WIDTH, 0), top + WIDTH + 1)
    if not PERIODS <= top <= n / SAMPLES or power[peak].sum() < SHARE * power.sum():
        return None
    frequency = float(power[peak] @ np.arange(peak.start, peak.start + len(power[peak])) / power[peak].sum()) / n
    turning = _averaged(y * np.exp(-2j * np.pi * frequency * k), max(1, round(1.0 / frequency)))
    at = np.arange(len(turning)) / frequency
    size = np.polyfit(at, np.log(np.abs(turning) + np.finfo(float).tiny), 1)
    phase = np.polyfit(at, np.unwrap(np.angle(turning)), 1)
    smooth = np.exp(np.polyval(size, at) + 1j * np.polyval(phase, at))
    amplitude, off = 2.0 * _rms(turning), 2.0 * _rms(turning - smooth)
    if amplitude < least or off**2 > (1.0 - SHARE) * amplitude**2 or size[0] * n < -DIES:
        return None
    growth = float(size[0]) if size[0] * n > GROWS else 0.0
    return frequency + float(phase[0]) / (2.0 * np.pi), growth


def _rms(x: NDArray[np.complex128]) -> float:
    return float(np.sqrt(np.mean(np.abs(x) ** 2)))


def _averaged(turning: NDArray[np.complex128], period: int) -> NDArray[np.complex128]:
    """The means over one period after the other."""
    whole = len(turning) // period
    return np.asarray(turning[: whole * period].reshape(whole, period).mean(axis=1))

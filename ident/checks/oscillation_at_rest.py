"""An oscillation that a machine keeps up by itself: its output swings on, or ever farther, while every input rests.

What rings after a step dies down. What is swung by itself does not: y = a exp(σ t) sin(ω t + φ) with σ ≥ 0, up to the
size at which friction, a stop or a limit holds it. The phase and the logarithm of the size of y exp(−iω t), averaged
over whole periods, are straight lines in time, whose slopes are the error of ω and σ. Where no rest holds ten periods,
several do together: each begins anew, with one frequency and one growth in all of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.checks.at_rest import acting, rests
from ident.noise.power_density import hann
from ident.rounding import TINY
from ident.run import BENCH, Run, Samples

PERIODS = 10  # of a stretch at least: fewer tell no growth
FEWEST = 3  # periods of each of several stretches, which have so many together
SLOWEST = 2  # lines of a stretch that a slow motion fills: what is slower tells no oscillation
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
    """The oscillation of the longest stretch at rest that shows one, else the oscillation of all such stretches
    together.

    None where none does.
    """
    inputs = acting(run)
    if run.kind in BENCH or not inputs:
        return None
    stretches = sorted(rests(inputs, PERIODS * SAMPLES), key=lambda one: one.start - one.stop)
    for of in [*((one,) for one in stretches), *tails(rests(inputs, FEWEST * SAMPLES))]:
        parts = [run.measured[stretch] for stretch in of]
        least = SIZE * float(np.ptp(run.measured))
        if run.output == "velocity":  # a ripple of what turns is driven round
            least = max(least, *(abs(float(y.mean())) for y in parts))
        found = _swings(parts, least)
        if found is not None:
            frequency, growth = found[0] * run.sample_rate, found[1] * run.sample_rate
            if run.time_unit != "s" or not is_of_mains(frequency):
                return AtRest(of[0].start / run.sample_rate, of[-1].stop / run.sample_rate, frequency, growth)
    return None


def tails(stretches: Sequence[slice]) -> list[tuple[slice, ...]]:
    """The ends of several stretches, three quarters of the shortest long: the response to a step has decayed there."""
    if len(stretches) < 2:
        return []
    length = 3 * min(one.stop - one.start for one in stretches) // 4
    return [tuple(slice(one.stop - length, one.stop) for one in stretches)]


def is_of_mains(frequency: float) -> bool:
    """Whether an oscillation, Hz, may be picked up from the mains."""
    return any(abs(frequency - mains) <= NEAR * mains for mains in MAINS)


def _swings(parts: Sequence[Samples], least: float) -> tuple[float, float] | None:
    """The frequency of an oscillation in stretches of one length, and its growth, both per sample.

    None where it decays, or is smaller than `least`.
    """
    n, count = len(parts[0]), len(parts)
    k = np.arange(n)
    flat = [y - np.polyval(np.polyfit(k, y, 1), k) for y in parts]
    power = np.sum([np.abs(np.fft.rfft(y * hann(n))) ** 2 for y in flat], axis=0)
    fewest = max(FEWEST, -(-PERIODS // count))
    top = SLOWEST + int(np.argmax(power[SLOWEST:]))
    peak, quick = slice(max(top - WIDTH, 0), top + WIDTH + 1), power[max(fewest - WIDTH, SLOWEST) :]
    if not fewest <= top <= n / SAMPLES or power[peak].sum() < SHARE * quick.sum():
        return None
    frequency = float(power[peak] @ np.arange(peak.start, peak.start + len(power[peak])) / power[peak].sum()) / n
    if n < FEWEST * max(1, round(1.0 / frequency)):
        return None
    found = [_followed(y, frequency) for y in flat]
    weight, off, slope, turn = (np.array(of) for of in zip(*found, strict=True))
    amplitude, growth = np.sqrt(2.0 * weight), float(slope @ weight / weight.sum())
    if amplitude.mean() < least or off.sum() > (1.0 - SHARE) * weight.sum() or growth * n * count < -DIES:
        return None
    return frequency + float(turn @ weight / weight.sum()), growth if growth * n * count > GROWS else 0.0


def _followed(y: Samples, frequency: float) -> tuple[float, float, float, float]:
    """What swings at about a frequency (1/sample): its power, what of it is not smooth, its growth, and how far off.

    The two straight lines take 4 of the 2 m numbers of m periods: m/(m − 2) makes up for that. Of three periods of
    noise the lines would leave a third, and of many periods all.
    """
    turning = _averaged(
        np.asarray(y * np.exp(-2j * np.pi * frequency * np.arange(len(y))), complex), max(1, round(1.0 / frequency))
    )
    at = np.arange(len(turning)) * max(1, round(1.0 / frequency))
    size = np.polyfit(at, np.log(np.abs(turning) + TINY), 1)
    phase = np.polyfit(at, np.unwrap(np.angle(turning)), 1)
    smooth = np.exp(np.polyval(size, at) + 1j * np.polyval(phase, at))
    power, off = 2.0 * _rms(turning) ** 2, 2.0 * _rms(turning - smooth) ** 2 * len(at) / max(len(at) - 2, TINY)
    return power, off, float(size[0]), float(phase[0]) / (2.0 * np.pi)


def _rms(x: NDArray[np.complex128]) -> float:
    return float(np.sqrt(np.mean(np.abs(x) ** 2)))


def _averaged(turning: NDArray[np.complex128], period: int) -> NDArray[np.complex128]:
    """The means over one period after the other."""
    whole = len(turning) // period
    return np.asarray(turning[: whole * period].reshape(whole, period).mean(axis=1))

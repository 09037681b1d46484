"""An oscillation that the command does not make: a loop beyond its stability, growing or settled in a limit cycle.

What the command explains is taken from the output, G U of their averaged spectra. A mode of a loop beyond its stability
is a line in the residual, whose amplitude A(t) in a band around it grows as exp(σ t), or is constant. A mode that noise
drives has the fluctuating amplitude of narrow-band noise, std(A)/mean(A) = 0.52 (Rice 1944); one that the command
drives is explained, or lies at a multiple of a command that repeats itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.fft  # not scipy.signal, which takes a second of every diagnosis to load
from numpy.typing import NDArray

from ident.checks.oscillation_at_rest import DIES, is_of_mains
from ident.noise.periodic import line_frequency
from ident.rounding import ROUNDING
from ident.run import Run, Samples

Spectrum = NDArray[np.complex128]
LONGEST = 131_072
"""Largest number of samples that are checked, the last ones of a record: a mode that grows is largest there."""
SHORTEST = 256
"""Least number of samples of a record that is checked."""
BAND = 0.2
"""Half width of the band in which the amplitude is followed, over the frequency."""
CYCLES = 60
"""Least number of cycles of an oscillation in a record: the amplitude of fewer is constant by chance."""
FEWER = 12
"""Least number of cycles where the command has no power at their frequency: it drives no mode by chance there."""
SILENT = 1e-3
"""Largest share of the command's power in the band of an oscillation in which it has no power."""
LITTLE = 0.2
"""Least deviation of an oscillation in such a band, over the output's deviation: less is a ripple."""
STEADY = 0.2
"""std(A)/mean(A) up to which an amplitude is constant; narrow-band noise has 0.52, over 60 cycles 0.3 at least."""
SHARE = 0.5
"""Least share of the oscillation in the output's variance: a limit cycle is most of it, a resonance may be less."""
GROWTH = 3.0
"""Least ln of the ratio by which an amplitude grows over the second half of a record: 20 times."""
STRAIGHT = 0.98
"""Least correlation of ln A with time for the growth of a mode."""
REPEATED = 0.9
"""Least correlation of a periodic command with itself a period later."""
DRIFT = 0.25
"""Turns by which an oscillation and the nearest multiple of a periodic command part over the record: one that parts by
less is driven."""
CHANCE = 0.3
"""Coherence of two signals of sixteen frames that have nothing to do with each other: 99 % of it lies below."""
_FRAMES = 16  # of the averaged spectra


@dataclass(frozen=True)
class Unexplained:
    """`frequency` in Hz, `growth` σ in 1/s, 0 where it has settled; `amplitude` in the output's unit, at the end."""

    frequency: float
    growth: float
    amplitude: float


def unexplained_oscillation(run: Run) -> Unexplained | None:
    """The oscillation of a run's output that its command does not make; None where there is none."""
    if "command" not in run.channels or run.length < SHORTEST or run.stepped:
        return None
    u, y = (_detrended(signal[-LONGEST:]) for signal in (run.command, run.measured))
    if not y.std() > ROUNDING * np.abs(run.measured).max() or not np.all(np.isfinite(u)):
        return None
    found = _growing(u, y, run.sample_rate) or _settled(_unexplained(u, y), SHARE * float(y.var()), run.sample_rate)
    if found is None and (found := _beside_silence(u, y, run.sample_rate)) and run.output == "velocity":
        level = abs(float(run.measured[-len(y) // 2 :].mean()))
        found = found if found.amplitude > level else None  # a ripple of what turns is driven round
    return None if found is None or _repeats(u, found.frequency / run.sample_rate) else found


def _beside_silence(u: Samples, y: Samples, rate: float) -> Unexplained | None:
    """The strongest oscillation of the last half of an output, or of all of it, where the command is silent."""
    for part in (slice(len(y) // 2, None), slice(None)):
        own = _detrended(y[part])
        if own.std() <= ROUNDING * np.abs(y).max():  # it stands, and the last digits oscillate
            continue
        first, power = int(_first_silent_line(u[part]) / (1.0 - 2.0 * BAND)), _line_powers(own)
        share = max(LITTLE**2, SHARE * float(power[first:].sum() / power.sum()))
        found = _settled(own, share * float(own.var()), rate, max(FEWER, first))
        if found and not is_of_mains(found.frequency):
            return found
    return None


def _line_powers(signal: Samples) -> Samples:
    """The power of each line of a signal's spectrum under Hann's window, (n // 2 + 1,)."""
    return np.asarray(np.abs(np.fft.rfft(signal * np.hanning(len(signal)))) ** 2)


def _first_silent_line(u: Samples) -> int:
    """The line of a command's spectrum from which on the command has next to no power."""
    power = _line_powers(u)
    return int(np.searchsorted(-np.cumsum(power[::-1])[::-1], -SILENT * power.sum()))


def _detrended(signal: Samples) -> Samples:
    n = np.linspace(-1.0, 1.0, len(signal))
    flat: Samples = signal - signal.mean() - n * float(n @ signal) / float(n @ n)
    return flat


def _unexplained(u: Samples, y: Samples) -> Samples:
    """The residual of the output after G u, G = S_uy/S_uu over Hann frames of half overlap (Welch 1967)."""
    n = len(u)
    frame = max(64, 2 * n // (_FRAMES + 1))
    starts = np.arange(0, n - frame + 1, frame // 2)
    window = np.hanning(frame)
    U, Y = (np.array([np.fft.rfft(window * signal[at : at + frame]) for at in starts]) for signal in (u, y))
    uu, yy, uy = (np.mean(a.conj() * b, axis=0) for a, b in ((U, U), (Y, Y), (U, Y)))
    both = np.maximum((uu * yy).real, 1e-300)
    related = np.clip((np.abs(uy) ** 2 / both - CHANCE) / (1.0 - CHANCE), 0.0, 1.0)
    G = related * uy / np.maximum(uu.real, 1e-300)
    at, known = np.fft.rfftfreq(n), np.fft.rfftfreq(frame)
    whole = np.interp(at, known, G.real) + 1j * np.interp(at, known, G.imag)
    left: Samples = y - np.fft.irfft(whole * np.fft.rfft(u), n)
    return left


def _settled(left: Samples, power: float, rate: float, cycles: int = CYCLES) -> Unexplained | None:
    """The strongest oscillation of a residual, where its amplitude is constant and it has a mean square `power`."""
    z = _strongest(left, cycles)
    if z is None:
        return None
    amplitude = np.abs(z)
    first, *_, last = (float(part.mean()) for part in np.array_split(amplitude, 4))
    if last < (1.0 - DIES) * first or np.std(amplitude) > STEADY * np.mean(amplitude):  # it rings down, or noise has it
        return None
    if np.mean(amplitude**2) / 2 < power:
        return None
    return Unexplained(_frequency(z, rate), 0.0, float(amplitude.mean()))


def _growing(u: Samples, y: Samples, rate: float) -> Unexplained | None:
    """The strongest oscillation of an output over the second half of a record, where it grows, and the command not so.

    In the first half the response to the command may hide it.
    """
    z = _strongest(y)
    if z is None:
        return None
    z = z[len(z) // 2 :]
    amplitude, time = np.abs(z), np.arange(len(z)) / rate
    logarithm = np.log(np.maximum(amplitude, 1e-300))
    growth = float(np.polyfit(time, logarithm, 1)[0])
    if growth * time[-1] < GROWTH or np.corrcoef(time, logarithm)[0, 1] < STRAIGHT:
        return None
    first, last = (float(np.std(part)) for part in np.array_split(u[-len(z) :], 2))
    if last > np.exp(GROWTH / 2) * first:  # what a command that grows makes grows with it
        return None
    return Unexplained(_frequency(z, rate), growth, float(amplitude[-1]))


def _strongest(signal: Samples, cycles: int = CYCLES) -> Spectrum | None:
    """The strongest oscillation of a signal (n,): z(t), |z| its amplitude, around whose frequency all else is left out.

    A window of Hann over time, moved along z = 2 y exp(−jω t), passes ω ± BAND ω. None of fewer `cycles`.
    """
    n = len(signal)
    power = _line_powers(signal)
    if len(power) <= cycles:
        return None
    at = cycles + int(np.argmax(power[cycles:]))
    window = np.hanning(int(2 * n / (BAND * at)) + 2)
    turned = 2 * signal * np.exp(-2j * np.pi * at / n * np.arange(n))
    if at >= (1 - BAND) * n / 2:
        return None
    size = scipy.fft.next_fast_len(n + len(window) - 1)
    products = scipy.fft.fft(turned, size) * scipy.fft.fft(window / window.sum(), size)
    kept = scipy.fft.ifft(products)[len(window) - 1 : n]
    z: Spectrum = kept * np.exp(2j * np.pi * at / n * np.arange(len(kept)))
    return z


def _frequency(z: Spectrum, rate: float) -> float:
    """The frequency (Hz) of an oscillation: of its steps from sample to sample, those of most amplitude count most."""
    return float(np.angle(np.sum(z[1:] * z[:-1].conj()))) * rate / (2 * np.pi)


def _repeats(u: Samples, frequency: float) -> bool:
    """Whether a command repeats itself and an oscillation (1/sample) is a multiple of its own frequency."""
    n = len(u)
    products = np.fft.irfft(np.abs(np.fft.rfft(u, 2 * n)) ** 2)[: n // 2] / np.arange(n, n - n // 2, -1)
    if not products[0] > 0:
        return False
    alike = products / products[0]
    fallen = int(np.argmax(alike < 0))  # before it does, a slow signal is like itself
    peaks = np.flatnonzero((alike[1:-1] >= REPEATED) & (alike[1:-1] >= alike[:-2]) & (alike[1:-1] >= alike[2:])) + 1
    peaks = peaks[peaks > fallen] if fallen else peaks[:0]
    if not len(peaks):
        return False
    period = _summit(alike, int(peaks[0]))
    period = _summit(alike, int(peaks[-1])) / max(1, round(peaks[-1] / period))  # of many, whose error is less
    highest = 1 + int(np.argmax(_line_powers(u)[1:]))
    order = max(1, round(highest * period / n))  # of the strongest line of the command
    cycles = line_frequency(u, order * n / period) / order
    return bool(abs(frequency * n - round(frequency * n / cycles) * cycles) < DRIFT)


def _summit(of: Samples, at: int) -> float:
    """The place of a peak between samples: of the parabola through three."""
    before, there, after = of[at - 1 : at + 2]
    bend = before - 2 * there + after
    return at + (0.5 * (before - after) / bend if bend else 0.0)

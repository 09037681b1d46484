"""An oscillation that sustains itself: no input makes it, and no disturbance of a stable machine.

Two facts tell it from all others.

* Its mode has no damping. The linear equation that fits a limit cycle has a pair of poles on the stability limit (Gelb
  and Vander Velde 1968, section 2.3): its decay is zero within its standard error. A stable machine forgets how it
  began, whatever its command.
* Its amplitude A(t) is constant, or grows. That of a mode which noise drives fluctuates: std(A)/mean(A) = 0.52 (Rice
  1944).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.fft  # not scipy.signal, which takes a second of every diagnosis to load
from numpy.typing import NDArray

from ident.checks.at_rest import acting, rests
from ident.checks.driven import is_multiple
from ident.checks.modes import FASTEST, Mode, modes
from ident.rounding import ROUNDING
from ident.run import BENCH, Run, Samples
from ident.statistics.robust import NORMAL

Spectrum = NDArray[np.complex128]
LONGEST = 131_072
"""Largest number of samples that are looked at, the last ones of a record: a matter of time alone."""
PERIODS = 10
"""Least number of periods of an oscillation: fewer tell no decay. Test: tests/checks/test_sustained_oscillation.py"""
DAMPING = 0.03
"""Largest damping ratio α/ω of an oscillation that does not die: a loop 3 dB from its stability limit has 0.04 or
more, an oil column 0.05 (Merritt 1967, section 6.1). Test: as above"""
ERRORS = 3.0
"""Standard errors of its decay beyond which an oscillation dies, and beyond which it grows. Test: as above"""
WINDOW = 4
"""Periods over which an amplitude is a mean: motions of other frequencies are left out, and a step is soon over.
Test: tests/checks/test_oscillation_at_rest.py"""
STEADY = 0.2
"""Deviation of an amplitude, by its quartiles, over its median, up to which it is constant: noise has 0.5.
Test: tests/checks/test_sustained_oscillation.py"""
STAYS = 0.85
"""Least amplitude in the last quarter of an oscillation over that in the first. Test: as above"""
GROWS = 0.5
"""Logarithm of the ratio by which an amplitude that is not constant grows over the record at least.
Test: tests/checks/test_oscillation_at_rest.py"""
EXPLAINED = 0.5
"""Largest share of an oscillation that is proportional to the inputs.
Test: tests/checks/test_sustained_oscillation.py"""
FEWEST = 8
"""Least number of amplitudes that a piece of a record gives: fewer tell no change. Test: as above"""
SIZE = 0.01
"""Least amplitude of an oscillation, over the range of the output: less may be the reading's. Test: as above"""
LITTLE = 0.2
"""Least amplitude of an oscillation, over √2 deviations of the output: less is a ripple.
Test: tests/checks/test_self_oscillation.py"""
MAINS, NEAR = (50.0, 60.0), 0.003
"""Frequencies (Hz) of the mains, and the relative distance within which an oscillation may be picked up from them.
Test: tests/checks/test_oscillation_at_rest.py"""
_QUARTILES = (0.25, 0.5, 0.75)


@dataclass(frozen=True)
class Oscillation:
    """Its `frequency` in turns a sample, `growth` per sample, 0 where it is steady, and `amplitude` at the end.

    The frequency is the median of the steps of its phase: a step of the command turns it, and soon is over. Their
    `mean` is more exact where nothing turns it. The amplitude is in the output's unit.
    """

    frequency: float
    mean: float
    growth: float
    amplitude: float


def sustained_oscillation(run: Run) -> Oscillation | None:
    """The strongest oscillation of a run's output that sustains itself; None where there is none.

    It is looked for in the rests of the inputs, where nothing drives the machine, and then in the whole record.
    """
    inputs = acting(run)
    if run.kind in BENCH or not inputs:
        return None
    signals = np.stack([signal[-LONGEST:] for signal in (run.measured, *inputs)])
    at_rest = [signals[:1, rest] for rest in rests(list(signals[1:]), round(WINDOW * 2.0 * np.pi / FASTEST))]
    for pieces in (at_rest, [signals]):
        level = max((abs(float(piece[0].mean())) for piece in pieces), default=0.0)
        found = [one for one in _sustained(pieces, signals) if not _is_driven(run, one, level)]
        if found:
            return max(found, key=lambda one: one.amplitude)
    return None


def _is_driven(run: Run, found: Oscillation, level: float) -> bool:
    """Whether the mains, a periodic command, or what turns at a mean speed `level` may drive an oscillation."""
    hertz = found.frequency * run.sample_rate
    if run.time_unit == "s" and any(abs(hertz - mains) <= NEAR * mains for mains in MAINS):
        return True
    if run.output == "velocity" and found.amplitude <= level:
        return True
    return "command" in run.channels and is_multiple(run.command[-LONGEST:], found.mean)


def _sustained(pieces: Sequence[Samples], signals: Samples) -> Iterator[Oscillation]:
    """The oscillations of the output, the first row of pieces of these signals, that do not die, and are steady or
    grow."""
    flat = [_detrended(piece) for piece in pieces]
    sizes = np.std(np.hstack(flat), axis=1, keepdims=True) if flat else np.zeros((1, 1))
    varying = sizes[:, 0] > ROUNDING * np.ptp(signals[: len(sizes)], axis=1)
    if not varying[0] or not np.isfinite(sizes).all():
        return
    scaled = [piece[varying] / sizes[varying] for piece in flat]
    least = max(LITTLE * np.sqrt(2.0), SIZE * np.ptp(signals[0]) / sizes[0, 0])
    for mode in modes(scaled):
        if mode.decay <= DAMPING * mode.frequency:
            found = _followed(scaled, mode)
            if found is not None and found.amplitude >= least:
                yield replace(found, amplitude=found.amplitude * float(sizes[0, 0]))


def _followed(pieces: Sequence[Samples], mode: Mode) -> Oscillation | None:
    """What turns at about the frequency of a mode, where its amplitude is constant or grows.

    What has grown may be constant in the last half.
    """
    period = 2.0 * np.pi / mode.frequency
    turning = [_demodulated(piece, mode.frequency) for piece in pieces if piece.shape[1] > WINDOW * period + FEWEST]
    output, *inputs = np.hstack(turning) if turning else np.zeros((1, 0), np.complex128)
    if len(output) + WINDOW * period * len(turning) < PERIODS * period or _explained(output, inputs) > EXPLAINED:
        return None
    amplitudes = [np.abs(of[0]) for of in turning]
    if _dies(amplitudes, mode):
        return None
    first = len(output) // 2 if mode.decay < 0.0 else 0
    amplitude = np.hstack(amplitudes)[first:]
    low, middle, high = np.quantile(amplitude, _QUARTILES)
    steady = 0.5 * NORMAL * (high - low) <= STEADY * middle
    if not steady and -mode.decay < max(ERRORS * mode.error, GROWS / len(output)):
        return None
    steps = np.hstack([np.angle(of[0, 1:] * of[0, :-1].conj()) for of in turning])[-len(amplitude) :]
    median, mean = ((mode.frequency + float(step)) / (2.0 * np.pi) for step in (np.median(steps), steps.mean()))
    if steady:
        return Oscillation(median, mean, 0.0, float(middle))
    return Oscillation(median, mean, -mode.decay, float(amplitude[-1]))


def _dies(amplitudes: Sequence[Samples], mode: Mode) -> bool:
    """Whether an oscillation dies: its amplitudes in pieces of a record fall, or they are too short to show it.

    Noise adds damping to a mode. A decay that would show in the amplitudes, and does not, is of the noise.
    """
    quarters = [(of[: -(-len(of) // 4)], of[-(len(of) // 4) - 1 :]) for of in amplitudes]
    begun, ended = (float(np.median(np.hstack(parts))) for parts in zip(*quarters, strict=True))
    shows = mode.decay * max(map(len, amplitudes)) > -2.0 * np.log(STAYS)
    return ended < STAYS * begun or (mode.decay > ERRORS * mode.error and not shows)


def _explained(output: Spectrum, inputs: Sequence[Spectrum]) -> float:
    """The share of what turns with one frequency in an output that is proportional to what does so in the inputs."""
    if not inputs:
        return 0.0
    table = np.stack(inputs, axis=1)
    rest = output - table @ np.linalg.lstsq(table, output, rcond=None)[0]
    return 1.0 - float(np.sum(np.abs(rest) ** 2) / np.sum(np.abs(output) ** 2))


def _demodulated(signals: Samples, frequency: float) -> Spectrum:
    """2 y exp(−jωk) averaged by Hann's window over some periods: its modulus is the amplitude of what turns with ω."""
    n = signals.shape[1]
    window = np.hanning(round(WINDOW * 2.0 * np.pi / frequency) + 2)
    size = scipy.fft.next_fast_len(n + len(window) - 1)
    turned = scipy.fft.fft(2.0 * signals * np.exp(-1j * frequency * np.arange(n)), size)
    averaged = scipy.fft.ifft(turned * scipy.fft.fft(window / window.sum(), size))
    return np.asarray(averaged[:, len(window) - 1 : n])


def _detrended(signals: Samples) -> Samples:
    """Signals, one (n,) or several (m, n), without their straight lines."""
    n = np.linspace(-1.0, 1.0, signals.shape[-1])
    return np.asarray(signals - signals.mean(axis=-1, keepdims=True) - (signals @ n / (n @ n))[..., None] * n)

"""The frequency response of a run as a check needs it: rough, quick, with its coherence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.noise.power_density import hann
from ident.run import Run, Samples

LONGEST_FRAME = 8192
FRAMES = 8  # at least: with fewer, chance alone makes a coherence of 0.4
SHORTEST_FRAME = 16
RELATED = 0.3  # mean coherence of two signals that have to do with each other; chance makes 0.12 of 8 frames
RESTS = 0.05  # scatter of a command that rests, over its level or the deviation of an output of the same unit
WHITE = 0.4
"""Half the mean square change of a recorder's noise from sample to sample, over its power, at least.

1 on an even clock, 0.5 where an uneven one was made even; a command of ten samples a cycle has 0.06.
"""


@dataclass(frozen=True, eq=False)
class Response:
    """Averages over Hann frames of half overlap, each frame without its mean (Welch 1967).

    `frequency` (F,) in Hz (or 1/sample) without 0; power of command `uu` and output `yy`, cross power `uy`, each (F,).
    `excited` is the number of frames over which the command's power P is spread, (Σ P)²/Σ P²: of one step it is about
    two, however many `frames` there are.
    Good enough to see a sign, a factor or a whole sample; the fit uses the exact spectra of :mod:`ident.fit.reduction`.
    """

    frequency: Samples
    uu: Samples
    yy: Samples
    uy: NDArray[np.complex128]
    frames: int
    excited: float

    @cached_property
    def gain(self) -> NDArray[np.complex128]:
        """H = uy / uu, (F,)."""
        return self.uy / self.uu

    @property
    def is_average(self) -> bool:
        """Whether the command moves in half of the least number of frames: else the output goes on while it rests, and
        a small coherence says nothing."""
        return self.excited >= FRAMES / 2

    @cached_property
    def coherence(self) -> Samples:
        """|uy|² / (uu yy), (F,), between 0 and 1."""
        value: Samples = np.abs(self.uy) ** 2 / (self.uu * self.yy)
        return value

    def below(self, share: float) -> float:
        """The frequency below which this share of the command's power lies."""
        power = np.cumsum(self.uu)
        return float(self.frequency[int(np.searchsorted(power, share * power[-1]))])

    def between(self, low: float, high: float) -> NDArray[np.bool_]:
        """The frequencies that carry the command's power from the share `low` to the share `high`."""
        return (self.frequency >= self.below(low)) & (self.frequency <= self.below(high))


def respond(run: Run) -> Response | None:
    """The response from command to output; None where there is none, it rests, or the record is too short to average.

    A command that is held throughout has no band and is followed by nothing: what spectrum it shows is that of its
    rounding, or of the noise with which it was recorded.
    """
    if "command" not in run.channels or run.stepped:
        return None
    found = response(run.command, run.measured, run.sample_rate)
    return None if found is None or _rests(run, found) else found


def rests(run: Run) -> bool:
    """Whether the command is held from the first sample to the last, but for its rounding and its recorder's noise."""
    if "command" not in run.channels or run.stepped:
        return "command" in run.channels
    found = response(run.command, run.measured, run.sample_rate) if _may_rest(run) else None
    return found is not None and _rests(run, found)


def _rests(run: Run, found: Response) -> bool:
    return _may_rest(run) and bool(found.coherence.mean() < RELATED)


def _may_rest(run: Run) -> bool:
    """Whether the command changes from sample to sample, as a recorder's noise does, and little for what it moves.

    White excitation does so, too; but that the output follows. One that moves as far as an output of its own unit is
    no rest: where that does not follow it, it is the record of something else.
    """
    power, successive = float(np.var(run.command)), 0.5 * float(np.mean(np.diff(run.command) ** 2))
    if successive < WHITE * power or run.units.get("command") != run.units.get(run.output):
        return successive >= WHITE * power
    return power <= (RESTS * max(abs(float(run.command.mean())), float(np.std(run.measured)))) ** 2


def response(u: Samples, y: Samples, sample_rate: float) -> Response | None:
    """The response from u (n,) to y (n,); None for a record that is too short to average."""
    length = min(LONGEST_FRAME, 1 << max(len(u) // (FRAMES // 2 + 1), 1).bit_length() - 1)
    if length < SHORTEST_FRAME:
        return None
    one, two = (_spectra(signal, hann(length)) for signal in (u, y))
    uy = (one.conj() * two).mean(axis=0)
    frequency = np.asarray(np.fft.rfftfreq(length, 1 / sample_rate)[1:], np.float64)
    power = (np.abs(one) ** 2).sum(axis=1)
    excited = float(power.sum() ** 2 / max((power**2).sum(), np.finfo(float).tiny))
    return Response(frequency, _power(one), _power(two), uy, len(one), excited)


def _spectra(signal: Samples, window: Samples) -> NDArray[np.complex128]:
    """The spectra of the frames that lie wholly in the signal, without 0 Hz, (frames, F)."""
    frames = np.lib.stride_tricks.sliding_window_view(signal, len(window))[:: len(window) // 2]
    found = np.fft.rfft((frames - frames.mean(axis=1, keepdims=True)) * window)
    return np.asarray(found[:, 1:], np.complex128)


def _power(frames: NDArray[np.complex128]) -> Samples:
    """The mean power of the frames, (F,), never 0 so that it may divide."""
    return np.asarray((np.abs(frames) ** 2).mean(axis=0) + np.finfo(float).tiny, np.float64)

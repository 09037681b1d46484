"""What commands do between their samples, where nobody says: by the look of their spectra.

Straight lines, unless they would lose what matters and the records show that nothing is hidden from them. Lines lose
1 − sinc²(f/fs) of a sine of frequency f. A command that was filtered before it was sampled, or is made of sines, ends
below half the sample rate fs/2, and its samples then say all of it (Shannon 1949). One that is held, or has corners,
has power up to there and beyond, as its noise has. All runs of a matrix are taken alike: one rig has made them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ident.run import BENCH, Run, Samples
from ident.words.sentence import first_of

LOST = 0.005
"""Of the command, RMS: lines that lose less, at every run, stay. Why: a good transducer has noise of 0.003, and what
lines lose is then taken for a lag of a sensor. Noise up to 80 Hz at 4096 Hz loses 0.0006, what moves at 26 samples a
cycle 0.005, the multisine of a benchmark that is band-limited 0.13. Below 0.004 a command that is held has no more in
the last tenth than EMPTY: what it has there is the square of that."""
EMPTY = 1e-5
"""Of the command's power: what the last tenth below half the rate holds at most of one that is band-limited. Why: of
measured records that lose more than LOST the band-limited ones have 5e-9 or less there, the others 1e-4 or more; where
a command jumps it is about the square of what lines lose, and where it has corners not much less."""
TOP = 0.9  # of half the sample rate: where the last tenth begins
FILLED = 16.0
"""Of a spectrum's frequencies: over so many the command's power must be spread, (Σ P)²/Σ P². Why: of a few tones, a
sine or a triangle, the last tenth may be empty by chance; a multisine, a sweep and noise fill a hundred."""
LEAST = 64  # samples: as many as the value between two of them is made of


def with_hold(runs: Sequence[Run], stated: Sequence[bool]) -> tuple[tuple[Run, ...], tuple[str, ...]]:
    """The runs, those of which no hold is stated with the one that is chosen for them, and that it was, in words."""
    left = {
        run.id: run.command
        for run, said in zip(runs, stated, strict=True)
        if not said and "command" in run.channels and run.kind not in BENCH and not run.stepped
    }
    if not are_band_limited(list(left.values())):
        return tuple(runs), ()
    told = (
        f"hold is not stated for {first_of(list(left))}, and the command's spectrum ends below half the sample rate: "
        "it is taken to be band-limited between its samples (hold: band-limited); state hold where it is held or drawn"
    )
    return tuple(replace(run, hold="band-limited") if run.id in left else run for run in runs), (told,)


def are_band_limited(commands: Sequence[Samples]) -> bool:
    """Whether the commands of one rig show that they are band-limited, and that it matters."""
    shown = [Spectrum.of(command) for command in commands if len(command) >= LEAST and np.ptp(command) > 0]
    matters = any(one.lost > LOST and one.filled >= FILLED for one in shown)
    return matters and all(one.top < EMPTY for one in shown)


@dataclass(frozen=True)
class Spectrum:
    """What the spectrum of a command says of the time between its samples.

    `lost` is what lines lose of it, RMS over its own; `top` the share of its power in the last tenth below half the
    sample rate; `filled` the number of frequencies that its power is spread over.
    """

    lost: float
    top: float
    filled: float

    @classmethod
    def of(cls, command: Samples) -> Spectrum:
        """Of a command (n,) that is not constant, under a Hann window."""
        spectrum = np.fft.rfft((command - command.mean()) * np.hanning(len(command)))
        power, of_rate = np.abs(spectrum) ** 2, np.arange(len(spectrum)) / len(command)
        power /= power.sum()
        lost = np.sqrt(np.sum(power * (1.0 - np.sinc(of_rate) ** 2) ** 2))
        return cls(float(lost), float(power[of_rate >= TOP / 2].sum()), float(1.0 / np.sum(power**2)))

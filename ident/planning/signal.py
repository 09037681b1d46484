"""A command of a plan: what it is, kept as plain data, from which its samples come the same each time."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ident.design.excitation import PERIODIC, RAMP, excitation
from ident.run import Specimen

Array = NDArray[np.float64]
BENCH = "bench"
"""The signal of a record whose current a law of the control unit makes."""


@dataclass(frozen=True)
class Signal:
    """A command of a position loop or of a valve: its kind, RMS in `unit` (SI), what it is played with.

    `frequency` (Hz) is that of a sine or a saw-tooth, else the upper edge; `ramp` the share of the record in which it
    grows and that in which it fades.
    """

    kind: str
    amplitude: float
    unit: str
    frequency: float
    seconds: float
    sample_rate: float
    seed: int = 0
    ramp: float = RAMP

    @property
    def samples(self) -> int:
        """Length of the command."""
        return max(64, round(self.seconds * self.sample_rate))

    def command(self) -> Array:
        """The command (n,) in `unit`, zero at both ends."""
        return excitation(
            self.kind, self.amplitude, self.samples, self.sample_rate, self.frequency, self.seed, self.ramp
        )

    @property
    def words(self) -> str:
        """The command in words."""
        where = "at" if self.kind in PERIODIC else "up to"
        return f"{self.kind} {where} {self.frequency:.3g} Hz"


@dataclass(frozen=True)
class AskedRun:
    """One run that a program asks for: the command, and what it is played under."""

    id: str
    signal: Signal
    kind: str
    specimen: Specimen | None = None
    gain: float | None = None
    use: str = "fit"


@dataclass(frozen=True)
class Program:
    """What is to be run: the runs in their order, and notes on where they come from."""

    name: str
    runs: tuple[AskedRun, ...]
    notes: tuple[str, ...] = field(default=())

"""What a plan has decided of one run: how large it is played, or why it cannot be."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ident.planning.law import Law
from ident.planning.signal import Signal
from ident.run import Specimen
from ident.words.conditions import amplitude
from ident.words.percent import percent


@dataclass(frozen=True, kw_only=True)
class PlannedRun:
    """One run as it is to be played: `signal`, or at a bench the `law` of its control unit.

    `asked` is the amplitude that the program asks for, in the unit of the signal, of a law its current in rated ones.
    `limit` is the tightest of the rig's and `share` what the run takes of it, `peaks` are all that are predicted, SI.
    """

    id: str
    kind: str
    use: str
    asked: float
    signal: Signal | None = None
    law: Law | None = None
    specimen: Specimen | None = None
    gain: float | None = None
    limit: str = ""
    share: float | None = None
    peaks: Mapping[str, float] = field(default_factory=dict)

    @property
    def size(self) -> float:
        """The amplitude that is planned, as `asked` is given."""
        if self.signal is not None:
            return self.signal.amplitude
        return 0.0 if self.law is None else self.law.size

    @property
    def scale(self) -> float:
        """What is left of the amplitude that the program asks."""
        return self.size / self.asked

    @property
    def words(self) -> str:
        """The size in words."""
        if self.signal is not None:
            return f"{amplitude(float(f'{self.size:.4g}'), self.signal.unit)} RMS"
        return amplitude(self.size, "m") if self.kind == "static" else percent(self.size)


@dataclass(frozen=True)
class RefusedRun:
    """A run that cannot be: why, and the factor by which its amplitude would have to shrink, None where none helps."""

    id: str
    why: str
    factor: float | None = None

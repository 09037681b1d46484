"""The conditions of a run as words, the same on every page."""

from __future__ import annotations

from dataclasses import dataclass

from ident.figures import words
from ident.run import Specimen
from ident.words.conditions import of_rated
from ident.words.engineering import quantity
from ident.words.number import count
from schemas.matrix import RunView


@dataclass(frozen=True)
class Conditions:
    """What a run was made under; `amplitude_value` sorts the column."""

    id: str
    use: str
    kind: str
    gain: str
    amplitude: str
    amplitude_value: str
    specimen: str
    length: str
    rate: str


def conditions(run: RunView) -> Conditions:
    """The words for a run; a dash where the matrix states nothing."""
    timed = run.time_unit == "s"
    return Conditions(
        id=run.id,
        use=run.use,
        kind=run.kind,
        gain="–" if run.gain is None else f"{run.gain:g}",
        amplitude=_amplitude(run),
        amplitude_value="" if run.amplitude is None else f"{run.amplitude:g}",
        specimen="–" if run.mass is None else words.specimen(specimen_of(run)),
        length=quantity(run.duration, "s") if timed else count(run.samples, "sample"),
        rate=quantity(run.sample_rate, "Hz") if timed else "unknown",
    )


def _amplitude(run: RunView) -> str:
    """RMS of the command; of a bench's sine the share of the rated current."""
    if run.amplitude is None:
        return "–"
    unit = run.units.get("command", "1")
    return of_rated(run.amplitude) if run.kind == "frequency" else words.amplitude(run.amplitude, unit)


def specimen_of(run: RunView) -> Specimen | None:
    """The specimen of a run, None where none is stated."""
    if run.mass is None:
        return None
    return Specimen(run.mass, run.stiffness or 0.0, run.damping or 0.0)

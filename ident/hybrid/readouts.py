"""What a data sheet says of a frequency response: −3 dB and −90° frequencies, and the margins of the loop."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ident.comparison.compare import RunComparison
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.hybrid.changed_machine import Change, changed_machine
from ident.hybrid.loop_figures import HALF_POWER, loop_figure
from ident.matrix import Actuator
from ident.run import Run, Specimen
from ident.words.number import plain

Array = NDArray[np.float64]
_POINTS = 1000
_BELOW, _STATIC = 1 / 30, 1e-4  # of the lowest frequency: the search begins there; the static gain is taken there
_LEVEL = 0.01  # by which a static gain may differ an octave below


@dataclass(frozen=True)
class Readouts:
    """Of one run: `bandwidth` (Hz) to 3 dB below the static gain, `lag_90` (Hz) where the phase falls to −90°.

    `gain_margin` (dB) and `phase_margin` (°) are those of the linearised loop, opened at its gain Kp. Each is None
    where there is none, below the frequency up to which it was searched.
    """

    bandwidth: float | None = None
    lag_90: float | None = None
    gain_margin: float | None = None
    phase_margin: float | None = None


def readouts(
    compared: RunComparison, fit: FitResult, actuator: Actuator, band: tuple[float, float], *, margins: bool = True
) -> Readouts:
    """Of the model's own response to the command of a run, up to the end of a `band` in Hz."""
    lowest, highest = band
    frequency = np.geomspace(_BELOW * lowest, highest, _POINTS)
    with np.errstate(all="ignore"):
        answer = compared.response(np.concatenate([_STATIC * lowest * np.array([1.0, 2.0]), frequency]))
    size, phase = np.abs(answer), np.degrees(np.unwrap(np.angle(answer)))
    if not np.isfinite(answer).all() or abs(size[1] / size[0] - 1) > _LEVEL:
        return Readouts()  # it integrates: it has no static gain
    phase = phase - 180.0 * np.round(phase[0] / 180.0)  # a sensor may be turned round
    decibel = 20 * np.log10(size / size[0])
    gain, turn = _margins(compared.run, fit, actuator) if margins else (None, None)
    return Readouts(
        _falls_to(frequency, decibel[2:], 20 * np.log10(HALF_POWER)), _falls_to(frequency, phase[2:], -90.0), gain, turn
    )


def _falls_to(frequency: Array, values: Array, level: float) -> float | None:
    """The first frequency at which the values fall to a level, on straight lines over log f; None where none does."""
    below = np.flatnonzero((values[:-1] > level) & (values[1:] <= level))
    if not len(below):
        return None
    at = below[0]
    share = (values[at] - level) / (values[at] - values[at + 1])
    return float(frequency[at] * (frequency[at + 1] / frequency[at]) ** share)


def _margins(run: Run, fit: FitResult, actuator: Actuator) -> tuple[float | None, float | None]:
    """Gain and phase margin of the loop under the conditions of a run."""
    if str(fit.settings.get("load", "none")) != "none":
        return None, None  # the specimen is not in the loop
    try:
        machine = changed_machine(replace(fit, actuator=actuator), Change(specimen=run.specimen or Specimen()))
        if not machine.has_gain or machine.output != run.output:
            return None, None
        found = [float(loop_figure(machine, name, np.array([run.Kp]))[0]) for name in ("gain_margin", "phase_margin")]
    except Unusable:
        return None, None
    gain, turn = (one if np.isfinite(one) else None for one in found)
    return gain, turn


def in_words(found: Sequence[Readouts], unit: str) -> tuple[str, ...]:
    """The readouts of some runs, a line each of frequencies and of margins; a range where they differ."""
    named = (("−3 dB at", "bandwidth", unit), ("−90° at", "lag_90", unit))
    loop = (("gain margin", "gain_margin", "dB"), ("phase margin", "phase_margin", "°"))
    return tuple(line for names in (named, loop) if (line := ", ".join(_said(found, names))))


def _said(found: Sequence[Readouts], names: Sequence[tuple[str, str, str]]) -> Iterator[str]:
    for text, name, unit in names:
        known = [value for one in found if (value := getattr(one, name)) is not None]
        if known and len(known) == len(found):
            least, most = plain(min(known), 3), plain(max(known), 3)
            space = "" if unit == "°" else " "
            size = least if least == most else f"{least} to {most}"
            yield f"{text} {size}{space}{unit}"

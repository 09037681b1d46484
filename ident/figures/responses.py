"""Measured and modelled frequency responses as the small table that a Bode plot draws."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.comparison.compare import RunComparison
from ident.figures import words
from ident.figures.thinning import Real, evenly_spaced, excited_band, significant
from ident.hybrid.readouts import Readouts
from ident.run import Run

MOST_POINTS, MOST_LINES = 1000, 1200  # rows: inline data stay below 300 kB
_POINTS, _LINES = (24, 80), (40, 160)  # of a run, at least and at most
MEASURED = "measured"
_SURE = 1.96  # standard errors on either side: 95 %
RELIABLE = 0.5  # coherence under which a point does not count for the limits of an axis

Complex = NDArray[np.complex128]
Row = dict[str, Any]


@dataclass(frozen=True)
class Responses:
    """The responses of some runs, their common frequency band, and what tells them apart.

    `others` are the same runs compared with another model, whose lines are drawn beside. `models` names the models
    where all entries are of one run, each with another model. `errors` give the standard errors of each entry's line.
    """

    compared: Sequence[RunComparison]
    logarithmic: bool = True
    others: Sequence[RunComparison] = ()
    models: Sequence[str] = ()
    errors: Sequence[Callable[[Real], tuple[Real, Real] | None]] = ()

    @cached_property
    def band(self) -> tuple[float, float]:
        """Frequency limits: where any of the commands has power."""
        bands = [excited_band(entry.run.command, entry.run.sample_rate) for entry in self.compared]
        lowest = min(float(entry.frequency[0]) for entry in self.compared)
        highest = max(float(entry.frequency[-1]) for entry in self.compared)
        lower = max(min(low for low, _ in bands), lowest)
        upper = max(*(high for _, high in bands), 10 * lower)  # a slow command leaves at least a decade to look at
        return lower, _rounded_up(min(upper, highest))

    @cached_property
    def labels(self) -> dict[str, str]:
        """Legend label by run id: in words what differs between the runs, or the id where words do not tell."""
        runs = [entry.run for entry in self.compared]
        namings: tuple[Callable[[Run], str], ...] = (_specimen, _amplitude)
        telling = [naming for naming in namings if len({naming(run) for run in runs}) > 1]
        labels = {run.id: "; ".join(naming(run) for naming in telling) for run in runs}
        if telling and len({(run.gain, labels[run.id]) for run in runs}) == len(runs):
            return labels
        return {run.id: run.id for run in runs}

    @cached_property
    def common(self) -> list[str]:
        """In words, what all runs share: specimen and amplitude."""
        runs = [entry.run for entry in self.compared]
        specimens, amplitudes = {_specimen(run) for run in runs}, {_amplitude(run) for run in runs}
        shared = [*specimens] if len(specimens) == 1 and runs[0].specimen is not None else []
        return shared + ([f"{_amplitude(runs[0])} RMS"] if len(amplitudes) == 1 and runs[0].amplitude else [])

    @cached_property
    def domain(self) -> list[str]:
        """Legend entries in numeric order (Vega would sort them as text)."""
        if self.models:
            return [MEASURED, *self.models]
        ordered = sorted((entry.run for entry in self.compared), key=_numeric)
        return list(dict.fromkeys(self.labels[run.id] for run in ordered))

    @cached_property
    def magnitude_unit(self) -> str:
        """ "dB", with the reference where output and command differ in unit."""
        run = self.compared[0].run
        into, out = run.units.get("command", "m"), run.units.get(run.output, "m")
        return "dB" if into == out else f"dB re {words.tidy_unit(out)}/{words.tidy_unit(into)}"

    @cached_property
    def points(self) -> dict[float | None, list[Row]]:
        """Measured, by gain: f frequency, a magnitude (dB), p phase (deg), c coherence, e relative error; s label."""
        entries = self.compared[:1] if self.models else self.compared
        count = _within(MOST_POINTS // len(entries), _POINTS)
        rows: dict[float | None, list[Row]] = {}
        for entry, own in zip(entries, self._own, strict=False):
            places = evenly_spaced(entry.frequency, *self.band, count, self.logarithmic)
            label = MEASURED if self.models else self.labels[entry.run.id]
            frequency, measured = entry.frequency[places], entry.measured[places]
            near = np.interp(frequency, self.frequency, np.unwrap(np.angle(own)))
            columns = {
                "f": frequency,
                "a": _decibel(measured),
                "p": np.degrees(near + np.angle(measured * np.exp(-1j * near))),  # the branch next to the model's
                "c": entry.coherence[places],
                "e": _SURE * entry.random_error[places],
            }
            rows.setdefault(entry.run.gain, []).extend(_rows(columns, label, entry.run.id))
        return rows

    @cached_property
    def lines(self) -> dict[float | None, list[Row]]:
        """The models, by gain: f frequency, A magnitude (dB), P phase (deg), u and v their errors; s label.

        B and Q are magnitude and phase of another model.
        """
        rows: dict[float | None, list[Row]] = {}
        others = {other.run.id: other for other in self.others}
        for place, entry in enumerate(self.compared):
            columns = dict(zip("AP", _bode(self._own[place]), strict=True))
            if self.errors and (error := self.errors[place](self.frequency)) is not None:
                columns |= {"u": 20 / np.log(10) * _SURE * error[0], "v": np.degrees(_SURE * error[1])}
            if entry.run.id in others:
                columns |= dict(zip("BQ", _bode(others[entry.run.id].response(self.frequency)), strict=True))
            label = self.models[place] if self.models else self.labels[entry.run.id]
            rows.setdefault(entry.run.gain, []).extend(_rows({"f": self.frequency, **columns}, label, entry.run.id))
        return rows

    def marks(self, read: Sequence[Readouts]) -> dict[float | None, list[Row]]:
        """Where each line has its −3 dB and −90° frequency, by gain: f, A or P; t says which, s label."""
        rows: dict[float | None, list[Row]] = {}
        for place, (found, entry) in enumerate(zip(read, self.compared, strict=False)):
            label = self.models[place] if self.models else self.labels[entry.run.id]
            curves = zip("AP", _bode(self._own[place]), ("−3 dB", "−90°"), (found.bandwidth, found.lag_90), strict=True)
            rows.setdefault(entry.run.gain, []).extend(
                {"f": at, name: float(np.interp(at, self.frequency, curve)), "t": text, "s": label, "r": entry.run.id}
                for name, curve, text, at in curves
                if at is not None and at >= self.frequency[0]
            )
        return rows

    @cached_property
    def _own(self) -> tuple[Complex, ...]:
        """The own response of each model, (f,)."""
        return tuple(entry.response(self.frequency) for entry in self.compared)

    @cached_property
    def frequency(self) -> Real:
        """Where the models are evaluated, (f,), Hz."""
        count = _within(MOST_LINES // len(self.compared), _LINES)
        return np.geomspace(*self.band, count) if self.logarithmic else np.linspace(*self.band, 2 * count)

    def limits(self, measured: str, modelled: str) -> tuple[float, float]:
        """Smallest and largest value of a field of the reliable points and of one of the lines, with a margin."""
        points = [row for group in self.points.values() for row in group]
        trusted = [row for row in points if (row["c"] or 0.0) >= RELIABLE] or points
        lines = [row for group in self.lines.values() for row in group]
        both = [row[measured] for row in trusted] + [row[modelled] for row in lines]
        values = [value for value in both if value is not None]
        low, high = min(values, default=0.0), max(values, default=1.0)
        margin = 0.04 * (high - low) or 1.0
        return low - margin, high + margin


def _within(count: int, ends: tuple[int, int]) -> int:
    return max(ends[0], min(ends[1], count))


def _bode(response: Complex) -> tuple[Real, Real]:
    """Magnitude (dB) and phase (deg, unwrapped)."""
    return _decibel(response), np.degrees(np.unwrap(np.angle(response)))


def _rows(columns: dict[str, Real], label: str, run: str) -> list[Row]:
    short = {name: significant(column, 3 if name in "ceuv" else 5) for name, column in columns.items()}
    return [
        {k: v if math.isfinite(v) else None for k, v in zip(short, row, strict=True)} | {"s": label, "r": run}
        for row in zip(*short.values(), strict=True)
    ]


def _rounded_up(value: float) -> float:
    """To two significant digits, so that an axis ends at 80 and not at 79.6."""
    step = 10.0 ** (math.floor(math.log10(value)) - 1)
    return float(f"{step * math.ceil(value / step * (1 - 1e-9)):.2g}")


def _decibel(response: Complex) -> Real:
    with np.errstate(divide="ignore"):
        return np.asarray(20 * np.log10(np.abs(response)))


def _specimen(run: Run) -> str:
    return words.specimen(run.specimen)


def _amplitude(run: Run) -> str:
    return words.amplitude(run.amplitude, run.units.get("command", "m"))


def _numeric(run: Run) -> tuple[float, float, float, str]:
    specimen = run.specimen
    mass, stiffness = (0.0, 0.0) if specimen is None else (specimen.mass, specimen.stiffness)
    return (mass, stiffness, run.amplitude or 0.0, run.id)

"""Measured and modelled frequency responses as the small table that a Bode plot draws."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ident.cached import cached_property
from ident.comparison.compare import RunComparison
from ident.figures import words
from ident.figures.thin import Places, excited_band, significant, spread
from ident.run import Run

MOST_ROWS = 2200  # inline data stay below 300 kB
RELIABLE = 0.5  # coherence under which a point does not count for the limits of an axis


@dataclass(frozen=True)
class Responses:
    """The responses of some runs, their common frequency band, and what tells them apart.

    `others` are the same runs compared with another model, whose lines are drawn beside.
    """

    compared: Sequence[RunComparison]
    logarithmic: bool = True
    others: Sequence[RunComparison] = ()

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
        ordered = sorted((entry.run for entry in self.compared), key=_numeric)
        return list(dict.fromkeys(self.labels[run.id] for run in ordered))

    @cached_property
    def magnitude_unit(self) -> str:
        """ "dB", with the reference where output and command differ in unit."""
        run = self.compared[0].run
        into, out = run.units.get("command", "m"), run.units.get(run.output, "m")
        return "dB" if into == out else f"dB re {words.tidy_unit(out)}/{words.tidy_unit(into)}"

    @cached_property
    def rows(self) -> dict[float | None, list[dict[str, Any]]]:
        """By gain: f frequency; a, A magnitude (dB) and p, P phase (deg), measured and model; c coherence; s label.

        B and Q are magnitude and phase of another model.
        """
        count = max(24, min(160, MOST_ROWS // len(self.compared)))
        rows: dict[float | None, list[dict[str, Any]]] = {}
        for entry in self.compared:
            places = spread(entry.frequency, *self.band, count, self.logarithmic)
            found = _rows(entry, places, self.labels[entry.run.id])
            other = next((each for each in self.others if each.run.id == entry.run.id), None)
            if other is not None:
                beside = _rows(other, places, "")
                found = [row | {"B": o["A"], "Q": o["P"]} for row, o in zip(found, beside, strict=True)]
            rows.setdefault(entry.run.gain, []).extend(found)
        return rows

    def limits(self, *fields: str) -> tuple[float, float]:
        """Smallest and largest reliable value of some fields over all runs, with a margin."""
        rows = [row for group in self.rows.values() for row in group]
        trusted = [row for row in rows if row["c"] >= RELIABLE] or rows
        values = [row[field] for row in trusted for field in fields if row[field] is not None]
        low, high = min(values, default=0.0), max(values, default=1.0)
        margin = 0.04 * (high - low) or 1.0
        return low - margin, high + margin


def _rows(entry: RunComparison, places: Places, label: str) -> list[dict[str, Any]]:
    model = np.unwrap(np.angle(entry.model))
    measured = model + np.angle(entry.measured * np.conj(entry.model))  # the branch next to the model's
    columns = {
        "f": entry.frequency,
        "a": _decibel(entry.measured),
        "A": _decibel(entry.model),
        "p": np.degrees(measured),
        "P": np.degrees(model),
        "c": entry.coherence,
    }
    short = {name: significant(np.asarray(column)[places], 5 if name != "c" else 3) for name, column in columns.items()}
    table = zip(*short.values(), strict=True)
    return [
        {k: v if math.isfinite(v) else None for k, v in zip(short, row, strict=True)} | {"s": label, "r": entry.run.id}
        for row in table
    ]


def _rounded_up(value: float) -> float:
    """To two significant digits, so that an axis ends at 80 and not at 79.6."""
    step = 10.0 ** (math.floor(math.log10(value)) - 1)
    return float(f"{step * math.ceil(value / step * (1 - 1e-9)):.2g}")


def _decibel(response: np.ndarray[Any, np.dtype[np.complex128]]) -> np.ndarray[Any, np.dtype[np.float64]]:
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

"""The numbers and names that figures print, each with its unit."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence

from ident.comparison.compare import RunComparison
from ident.figures.theme import Look
from ident.fit.result import FitResult
from ident.matrix import Actuator
from ident.run import USES, Run, Specimen
from ident.words import conditions
from ident.words.display import displayed
from ident.words.engineering import power_of, printed_unit, scaled_unit
from ident.words.error import ErrorOf
from ident.words.percent import PER_CENT
from ident.words.percent import percent as in_percent
from ident.words.run_name import run_name
from ident.words.titles import DATA

_ACROSS = 105
"""[letters] Of a caption that a figure of the usual width has room for. Test: tests/browser/test_pages.py."""
_SIGNS = "²³"  # raised: a 4 or a minus is missing from too many fonts


def percent(fraction: float | None) -> str:
    """0.0407 → "4.07 %", with a printer's minus; "unknown" where there is none."""
    return in_percent(fraction, "unknown", "−")


def tidy_unit(unit: str) -> str:
    """``m^3/(s*Pa)`` → m³/(s·Pa)."""
    return printed_unit(unit, _SIGNS)


def engineering(values: Iterable[float], unit: str) -> tuple[float, str]:
    """(factor, unit) that bring the largest of `values` into a readable range: 2.6e-6 m^4/s → (1e6, "1e-6 m^4/s").

    Fractions of the unit % are brought into per cent.
    """
    if unit == "%":
        return PER_CENT, unit
    size, unit = displayed(unit)
    power = power_of(max((abs(value) for value in values), default=0.0) / size)
    return 10.0**-power / size, scaled_unit(unit, power, _SIGNS) if power else tidy_unit(unit)


def whole(unit: str) -> tuple[float, str]:
    """(factor, unit) of the display unit itself, without a power of ten: for an axis of decades."""
    size, unit = displayed(unit)
    return 1 / size, tidy_unit(unit)


def axis(name: str, unit: str) -> str:
    """An axis title: name and unit."""
    return f"{name} ({unit})" if unit not in ("", "1") else f"{name} (–)"


def specimen(of: Specimen | None) -> str:
    """A specimen as legends print it."""
    if of is None:
        return "specimen not stated"
    if of.mass == 0 and of.stiffness == 0:
        return "no specimen"
    return f"{conditions.mass(of.mass)}, {conditions.stiffness(of.stiffness)}"


def amplitude(of: float | None, unit: str = "m") -> str:
    """An RMS amplitude as legends print it."""
    return "amplitude not stated" if of is None else conditions.amplitude(of, unit)


def gain(of: float | None) -> str:
    """A loop gain as facets print it."""
    return "Kp not stated" if of is None else f"Kp {of:g}"


def headline(actuator: Actuator, what: str) -> str:
    """A figure's title."""
    return f"{actuator.serial} · {what}"


def wrapped(lines: Sequence[str], look: Look) -> list[str]:
    """Lines of a caption, each broken where a figure of the usual width ends."""
    return [part for line in lines for part in textwrap.wrap(line, look.across(_ACROSS))]


def verdict(fit: FitResult) -> str:
    """Model and errors in one line."""
    model = " + ".join((fit.model, *fit.effects))
    known = [(use, of) for use in USES if (of := fit.error_of(use)).error is not None]
    errors = ", ".join(f"{error(of)} {DATA[use]}" for use, of in known if not of.is_unstable)
    unstable = [f"{error(of)} ({DATA[use]})" for use, of in known if of.is_unstable]
    said = ([f"error {errors}"] if errors else []) + unstable
    return f"Model {model}, {', '.join(said) or 'error unknown'}"


def left(of: RunComparison) -> str:
    """Error and offset of a run in a caption."""
    said = error(of.words)
    return said if of.unstable else f"error {said}, offset {percent(of.offset)}"


def error(of: ErrorOf) -> str:
    """An error in a caption: with the mean where it counts, "unstable on run k24" where the model is."""
    return of.said(percent)


def describe(run: Run) -> str:
    """A run in one line: id, gain, amplitude, specimen, as far as stated."""
    parts = [run_name(run.id)]
    if run.gain is not None:
        parts.append(gain(run.gain))
    if run.amplitude is not None:
        of_bench = run.kind == "frequency"
        parts.append(
            conditions.of_rated(run.amplitude)
            if of_bench
            else f"{amplitude(run.amplitude, run.units.get('command', 'm'))} RMS"
        )
    if run.specimen is not None:
        parts.append(specimen(run.specimen))
    return ", ".join(parts)

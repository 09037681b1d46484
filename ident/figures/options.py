"""The options that several figures take: which runs, which band, which curve; and an option that is a number."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from ident.errors import Unusable
from ident.figures import words
from ident.figures.drawing import Choices, Offer, OfferedRun, Option
from ident.presets import preset
from ident.residuals.views import views
from ident.words.titles import runs as data_runs

ANY = ("", "any")


def _uses(of: Offer) -> Choices:
    first = "verify" if any(run.use == "verify" for run in of.runs) else "fit"
    others = tuple((use, data_runs(use)) for use in ("fit",) if first == "verify")
    return (("", data_runs(first)), *others, ("all", "all runs"))


def _gains(of: Offer) -> Choices:
    return (ANY, *_stated(of, lambda run: run.gain, words.gain))


def _amplitudes(of: Offer) -> Choices:
    units = {run.unit for run in of.runs}
    unit = units.pop() if len(units) == 1 else "1"
    return (ANY, *_stated(of, lambda run: run.amplitude, lambda size: words.amplitude(size, unit)))


def _stated(of: Offer, number: Callable[[OfferedRun], float | None], text: Callable[[float], str]) -> Choices:
    """The stated values in numeric order, as query and as words."""
    found = sorted({value for run in of.runs if (value := number(run)) is not None})
    return tuple((f"{value:.6g}", text(value)) for value in found)


def _specimens(of: Offer) -> Choices:
    known = [run.specimen for run in of.runs if run.specimen is not None]
    ordered = sorted(known, key=lambda one: (one.mass, one.stiffness))
    return (ANY, *((text, text) for text in dict.fromkeys(map(words.specimen, ordered))))


def _views(of: Offer) -> Choices:
    return (("", "those that explain most"), *((view.name, view.name) for view in views(preset(of.fit.model))))


def _axes(_: Offer) -> Choices:
    return (("log", "logarithmic"), ("linear", "linear"))


RUN = Option("run", picked=True)
LOW, HIGH = Option("low", picked=True), Option("high", picked=True)
BAND = (LOW, HIGH)
"""The options of a figure that shows a band, Hz."""
USE = Option("use", "Runs", choices=_uses)
CONDITIONS = (
    Option("kp", "Gain", choices=_gains),
    Option("amplitude", "Amplitude, RMS", choices=_amplitudes),
    Option("specimen", "Specimen", choices=_specimens),
)
"""The options of a figure that shows runs under some conditions."""
MANY = (RUN, *CONDITIONS, replace(USE, label=""))
"""Those of a figure that by itself shows many runs, whatever they are used for."""
AXIS = Option("axis", "Frequency axis", takes=str | None, choices=_axes)
VIEW = Option("view", "Curve", takes=str | None, choices=_views)
CANDIDATE = Option("candidate", takes=Any)
"""Another fit, judged where it is used."""
OTHER = Option("other", takes=Any)
"""Other fits, which are drawn over this one."""


def number(options: Mapping[str, Any], name: str) -> float | None:
    """An option that is a number. Raises Unusable."""
    value = options.get(name)
    try:
        return None if value in (None, "") else float(value)
    except (TypeError, ValueError):
        raise Unusable("not-a-number", f"{name} is {value!r}", "figure option", "give a number") from None


def whole_number(options: Mapping[str, Any], name: str, least: int, most: int) -> int | None:
    """An option that is a whole number from `least` to `most`. Raises Unusable."""
    value = number(options, name)
    if value is None:
        return None
    if not value.is_integer():
        raise Unusable("not-a-number", f"{name} is {value:g}", "figure option", "give a whole number")
    if not least <= value <= most:
        raise Unusable("out-of-range", f"{name} is {value:g}", "figure option", f"give {least} to {most}")
    return int(value)

"""Results in, charts out: one figure a file, one definition for page, SVG, PNG and PDF."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from ident.compare import Comparison, compare
from ident.errors import Unusable
from ident.figures.bench import BENCH_FIGURES
from ident.figures.bode import bode, readable
from ident.figures.choose import chosen, wish
from ident.figures.evolution import evolution
from ident.figures.ladder import ladder
from ident.figures.look import Look, look
from ident.figures.render import MEDIA, Chart, render
from ident.figures.residual_curve import residual_curve
from ident.figures.residual_map import residual_map
from ident.figures.sensitivity import loaded, sensitivity
from ident.figures.time import time, typical
from ident.fit.result import FitResult
from ident.matrix import Matrix, Run
from ident.residuals.curves import curves

__all__ = ["BENCH_FIGURES", "FIGURES", "MEDIA", "Chart", "figure", "figures_of", "ladder", "look", "render"]


def figure(name: str, matrix: Matrix, fit: FitResult, theme: str = "light", **options: Any) -> Chart:
    """The chart of that name, "light" or "dark"; only what it shows is computed.

    Options, all optional: bode takes run, kp, amplitude, specimen, use, axis; time takes run, start, seconds;
    evolution takes x, y, generations; sensitivity takes run; residual-map takes kp, amplitude, specimen, use;
    residual-curve takes these, view, and candidate, the fit of another model; speed-characteristic, of a bench, takes
    smoothing.

    Raises Unusable for an unknown name, theme or option.
    """
    if name not in figures_of(fit):
        raise Unusable("unknown-figure", f"no figure {name!r}", "figure", f"use one of {', '.join(figures_of(fit))}")
    draw, known = FIGURES[name] if name in FIGURES else BENCH_FIGURES[name]
    for option in options:
        if option not in known:
            raise Unusable("unknown-option", f"no option {option!r}", f"figure {name}", f"use {', '.join(known)}")
    return draw(matrix, fit, look(theme), options)


def _bode(matrix: Matrix, fit: FitResult, of: Look, options: Mapping[str, Any]) -> Chart:
    filters = {name: value for name, value in options.items() if name != "axis"}
    candidates = chosen(matrix, wish(**filters))
    shown = _compared(matrix, fit, readable(candidates))
    return bode(shown.runs, matrix.actuator, fit, of, axis=options.get("axis") or "log", candidates=len(candidates))


def _time(matrix: Matrix, fit: FitResult, of: Look, options: Mapping[str, Any]) -> Chart:
    run = _one(matrix, options) or typical(matrix, fit)
    (shown,) = _compared(matrix, fit, (run,)).runs
    return time(shown, matrix.actuator, fit, of, start=_number(options, "start"), seconds=_number(options, "seconds"))


def _evolution(matrix: Matrix, fit: FitResult, of: Look, options: Mapping[str, Any]) -> Chart:
    return evolution(matrix.actuator, fit, of, **options)


def _sensitivity(matrix: Matrix, fit: FitResult, of: Look, options: Mapping[str, Any]) -> Chart:
    run = _one(matrix, options) or loaded(matrix.of_use("verify") or matrix.runs)
    return sensitivity(run, matrix.actuator, fit, of)


def _residual_map(matrix: Matrix, fit: FitResult, of: Look, options: Mapping[str, Any]) -> Chart:
    shown = chosen(matrix, wish(**options)) if any(options.values()) else matrix.runs
    return residual_map(_compared(matrix, fit, shown), matrix.actuator, fit, of)


def _residual_curve(matrix: Matrix, fit: FitResult, of: Look, options: Mapping[str, Any]) -> Chart:
    filters = {name: value for name, value in options.items() if name not in ("view", "candidate")}
    shown = chosen(matrix, wish(**filters)) if any(filters.values()) else matrix.of_use("fit") or matrix.runs
    own = _compared(matrix, fit, shown)
    other = options.get("candidate")
    if other is not None and not isinstance(other, FitResult):
        raise Unusable("bad-fit", f"candidate is {other!r}", "figure residual-curve", "give a fit")
    predicted = curves(own, _compared(matrix, other, shown)) if other else ()
    return residual_curve(
        curves(own), matrix.actuator, fit, of, candidate=predicted, view=options.get("view"), runs=len(shown),
        candidate_name=" + ".join((other.model, *other.effects)) if other else "",
    )  # fmt: skip


_CONDITIONS = ("kp", "amplitude", "specimen", "use")
FIGURES: Mapping[str, tuple[Callable[[Matrix, FitResult, Look, Mapping[str, Any]], Chart], tuple[str, ...]]] = {
    "bode": (_bode, ("run", "kp", "amplitude", "specimen", "use", "axis")),
    "time": (_time, ("run", "start", "seconds")),
    "evolution": (_evolution, ("x", "y", "generations")),
    "sensitivity": (_sensitivity, ("run",)),
    "residual-map": (_residual_map, _CONDITIONS),
    "residual-curve": (_residual_curve, (*_CONDITIONS, "view", "candidate")),
}
"""Figures by name, each with the options that it takes."""


def figures_of(fit: FitResult) -> tuple[str, ...]:
    """Names of the figures that a fit has: a bench's model has no linear core, and figures of its own."""
    if fit.model != "kononykhin":
        return tuple(FIGURES)
    return ("time", *(("evolution",) if fit.evolution else ()), *BENCH_FIGURES)


def _compared(matrix: Matrix, fit: FitResult, runs: tuple[Run, ...]) -> Comparison:
    return compare(replace(matrix, runs=runs), fit)


def _one(matrix: Matrix, options: Mapping[str, Any]) -> Run | None:
    """The run that was asked for by its id."""
    return None if not options.get("run") else chosen(matrix, wish(run=options["run"]))[0]


def _number(options: Mapping[str, Any], name: str) -> float | None:
    value = options.get(name)
    try:
        return None if value in (None, "") else float(value)
    except (TypeError, ValueError):
        raise Unusable("not-a-number", f"{name} is {value!r}", "figure option", "give a number") from None

"""Results in, charts out: one figure a file, one definition for page, SVG, PNG and PDF."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from ident.custom.definition import preset_with
from ident.errors import Unusable
from ident.figures import words
from ident.figures.bench import BENCH_FIGURES
from ident.figures.bode import bode, readable
from ident.figures.choose import chosen, wish
from ident.figures.evolution import evolution
from ident.figures.frame import unchecked
from ident.figures.ladder import ladder
from ident.figures.look import Look, look
from ident.figures.render import MEDIA, Chart, render
from ident.figures.residual_curve import residual_curve
from ident.figures.residual_map import residual_map
from ident.figures.selection import band_of, number
from ident.figures.sensitivity import loaded, sensitivity
from ident.figures.study import Study
from ident.figures.time import time, typical
from ident.fit.result import FitResult
from ident.matrix import Matrix, Run
from ident.words.titles import title

__all__ = ["BENCH_FIGURES", "FIGURES", "MEDIA", "Chart", "Study", "figure", "figures_of", "ladder", "look", "render"]


def figure(name: str, study: Study, theme: str = "light", share: float = 1.0, **options: Any) -> Chart:
    """The chart of that name, "light" or "dark", `share` as wide as usual; only what it shows is computed.

    `study` is a fit beside its data, with what earlier figures of it have computed.

    Options, all optional: bode takes run, kp, amplitude, specimen, use, low, high, axis, candidate; time takes run,
    start, seconds, low, high; evolution takes x, y, generations; sensitivity takes run; residual-map takes what bode
    takes but axis and candidate; residual-curve takes these, view, and candidate, the fit of another model drawn
    dashed; speed-characteristic, of a bench, takes smoothing.

    Raises Unusable for an unknown name, theme or option.
    """
    names = figures_of(study.fit)
    if name not in names:
        raise Unusable("unknown-figure", f"no figure {name!r}", "figure", f"use one of {', '.join(names)}")
    draw, known = _drawing(name, study)
    for option in options:
        if option not in known:
            raise Unusable("unknown-option", f"no option {option!r}", f"figure {name}", f"use {', '.join(known)}")
    with unchecked():
        return draw(look(theme, share), options)


def _drawing(name: str, study: Study) -> tuple[Callable[[Look, Mapping[str, Any]], Chart], tuple[str, ...]]:
    """What draws a figure, with the options that it takes."""
    if name in FIGURES:
        draw, known = FIGURES[name]
        return partial(draw, study), known
    of_bench, known = BENCH_FIGURES[name]
    return partial(of_bench, study.matrix, study.fit), known


def _bode(study: Study, of: Look, options: Mapping[str, Any]) -> Chart:
    candidates = chosen(study.matrix, wish(**_only(options, _RUNS)))
    runs, other = readable(candidates), _candidate(options)
    return bode(
        study.compared(runs).runs, study.matrix.actuator, study.fit, of,
        axis=options.get("axis") or "log", candidates=len(candidates), band=band_of(options),
        others=study.beside(other).compared(runs).runs if other else (), other_name=_name(other, study.fit),
    )  # fmt: skip


def _time(study: Study, of: Look, options: Mapping[str, Any]) -> Chart:
    run = _one(study.matrix, options) or typical(study.matrix, study.fit)
    (shown,) = study.compared((run,)).runs
    start, seconds = number(options, "start"), number(options, "seconds")
    return time(shown, study.matrix.actuator, study.fit, of, start=start, seconds=seconds, band=band_of(options))


def _evolution(study: Study, of: Look, options: Mapping[str, Any]) -> Chart:
    return evolution(study.matrix.actuator, study.fit, of, **options)


def _sensitivity(study: Study, of: Look, options: Mapping[str, Any]) -> Chart:
    run = _one(study.matrix, options) or loaded(study.matrix.of_use("verify") or study.matrix.runs)
    return sensitivity(run, study.matrix.actuator, study.fit, of)


def _residual_map(study: Study, of: Look, options: Mapping[str, Any]) -> Chart:
    filters = _only(options, _CONDITIONS)
    shown = chosen(study.matrix, wish(**filters)) if any(filters.values()) else study.matrix.runs
    run = str(options.get("run") or "")
    return residual_map(study.compared(shown), study.matrix.actuator, study.fit, of, run=run, band=band_of(options))


def _residual_curve(study: Study, of: Look, options: Mapping[str, Any]) -> Chart:
    matrix, filters, view = study.matrix, _only(options, _RUNS), options.get("view") or None
    band, other = band_of(options), _candidate(options)
    shown = chosen(matrix, wish(**filters)) if any(filters.values()) else matrix.of_use("fit") or matrix.runs
    runs = words.describe(shown[0]) if len(shown) == 1 else f"{len(shown)} runs"
    return residual_curve(
        study.curves(shown, view, band), matrix.actuator, study.fit, of,
        candidate=study.curves(shown, view, band, other) if other else (), view=view,
        runs=f"{runs}, {band.words}" if band else runs,
        candidate_name=_name(other, study.fit),
    )  # fmt: skip


def _candidate(options: Mapping[str, Any]) -> FitResult | None:
    """The other fit that is drawn beside this one. Raises Unusable where it is none."""
    other = options.get("candidate")
    if other is not None and not isinstance(other, FitResult):
        raise Unusable("bad-fit", f"candidate is {other!r}", "figure option candidate", "give a fit")
    return other


def _name(other: FitResult | None, fit: FitResult) -> str:
    """What the other fit is called: what it has more than this one, where it has no less."""
    if other is None:
        return ""
    more = [title(effect) for effect in other.effects if effect not in fit.effects]
    wider = other.model == fit.model and set(fit.effects) < set(other.effects)
    return " + ".join(more if wider else (other.model, *other.effects))


_CONDITIONS = ("kp", "amplitude", "specimen", "use")
_RUNS = ("run", *_CONDITIONS)
_BAND = ("low", "high")
FIGURES: Mapping[str, tuple[Callable[[Study, Look, Mapping[str, Any]], Chart], tuple[str, ...]]] = {
    "bode": (_bode, (*_RUNS, *_BAND, "axis", "candidate")),
    "time": (_time, ("run", *_BAND, "start", "seconds")),
    "evolution": (_evolution, ("x", "y", "generations")),
    "sensitivity": (_sensitivity, ("run",)),
    "residual-map": (_residual_map, (*_RUNS, *_BAND)),
    "residual-curve": (_residual_curve, (*_RUNS, *_BAND, "view", "candidate")),
}
"""Figures by name, each with the options that it takes."""


def figures_of(fit: FitResult) -> tuple[str, ...]:
    """Names of the figures that a fit has: a bench's model has no linear core, and figures of its own."""
    names = preset_with(fit.model).figures or tuple(FIGURES)
    drawn_always = preset_with(fit.model).kind == "chain"
    return tuple(name for name in names if drawn_always or fit.evolution or name != "evolution")


def _one(matrix: Matrix, options: Mapping[str, Any]) -> Run | None:
    """The run that was asked for by its id."""
    return None if not options.get("run") else chosen(matrix, wish(run=options["run"]))[0]


def _only(options: Mapping[str, Any], names: tuple[str, ...]) -> dict[str, Any]:
    return {name: options[name] for name in names if name in options}

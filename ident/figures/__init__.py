"""Results in, charts out: one figure a file, one definition for page, SVG, PNG and PDF, one catalogue of all.

A figure is a value of :class:`Drawing`: what it is of, such as a fit beside its data, and the options that it takes.
Forms, commands, the service and the documentation read them from the catalogue.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from ident.custom.definition import preset_with
from ident.diagnosis.result import Diagnosis
from ident.errors import Unusable
from ident.figures.chart_template import unchecked
from ident.figures.drawing import Drawing
from ident.figures.render import MEDIA, AltairChart, Chart, render, renders, shown
from ident.figures.study import Study
from ident.figures.subjects import Ladder, Recorded
from ident.figures.theme import look
from ident.fit.result import FitResult
from ident.matrix import Actuator
from ident.presets import Preset
from ident.words.arguments import of_kind
from ident.words.nearest import did_you_mean
from ident.words.titles import title

__all__ = [
    "DRAWINGS", "FIGURES", "MEDIA", "AltairChart", "Chart", "Recorded", "Study", "drawings", "figure", "figures_for",
    "figures_of", "look", "of_diagnosis", "render", "renders", "shown",
]  # fmt: skip

_FILES = (
    "residual_map",
    "bode",
    "time",
    "step",
    "pole_zero",
    "residual_spectrum",
    "residual_curve",
    "residual_correlation",
    "sensitivity",
    "evolution",
    "starts",
    "pressure_loop",
    "frequency_characteristics",
    "speed_characteristic",
    "acceptance_sheet",
    "profile_likelihood",
    "side_by_side",
    "ladder",
    "closed_loop",
    "hybrid_time",
    "hybrid_response",
    "acceleration",
    "share_map",
    "delay_map",
    "feedforward",
    "what_if_response",
    "root_locus",
    "loop_margins",
    "tracking",
    "control_chart",
    "dependence",
    "signals",
    "spectra",
)
"""Each with one figure, those of a fit in the order of the tabs of a page."""
DRAWINGS: tuple[Drawing[Any], ...] = tuple(
    getattr(import_module(f"ident.figures.{file}"), file.upper()) for file in _FILES
)
FIGURES = {drawing.name: drawing for drawing in DRAWINGS if drawing.of is Study}
"""Those of a fit beside its data."""


def drawings(subject: object) -> dict[str, Drawing[Any]]:
    """The figures that there are of a subject, by name."""
    if isinstance(subject, Study):
        return {name: FIGURES[name] for name in figures_of(subject.fit)}
    of_its_kind = (drawing for drawing in DRAWINGS if drawing.of is type(subject))
    return {drawing.name: drawing for drawing in of_its_kind if drawing.there(subject)}


def figure(name: str, subject: object, theme: str = "light", share: float = 1.0, **options: Any) -> Chart:
    """The chart of that name, "light" or "dark", `share` as wide as usual; only what it shows is computed.

    `subject` is what it is of: a :class:`Study`, a fit beside its data with what earlier figures of it have computed,
    or another that a drawing of the catalogue is `of`. The options, all optional, are those of the drawing.

    Raises Unusable for an unknown name, theme or option.
    """
    there = drawings(subject)
    if name not in there:
        raise Unusable("unknown-figure", f"no figure {name!r}", "figure", did_you_mean(name, there))
    known = {option.name: option for option in there[name].options}
    for option, value in options.items():
        if option not in known:
            remedy = did_you_mean(option, (*known, "theme", "share"))
            raise Unusable("unknown-option", f"no option {option!r}", f"figure {name}", remedy)
        of_kind(f"figure {name}", option, value, known[option].takes)
    with unchecked():
        return there[name].draw(subject, look(theme, share), options)


def of_diagnosis(
    found: Diagnosis, name: str, actuator: Actuator, theme: str = "light", share: float = 1.0, **options: Any
) -> Chart:
    """The figure of a diagnosis: its ladder, the error with each effect added. Raises Unusable for any other."""
    if name != "ladder" or options:
        what = f"no option {next(iter(options))!r}" if options else f"no figure {name!r} of a diagnosis"
        raise Unusable("unknown-figure", what, "figure", "use ladder, or give the fit")
    steps = [
        (title(rung.added or "") or found.model, rung.error.get("fit"), rung.error.get("verify"))
        for rung in found.ladder
    ]
    return figure("ladder", Ladder(steps, found.noise_floor.get("fit"), actuator), theme, share)


def figures_of(fit: FitResult) -> tuple[str, ...]:
    """Names of the figures that a fit has: those of its model, of a search as far as it kept them."""
    model = preset_with(fit.model)
    kept = {"evolution": model.kind == "chain" or fit.evolution, "starts": fit.starts and len(fit.starts.errors) > 1}
    return tuple(name for name in figures_for(model) if kept.get(name, True))


def figures_for(model: Preset) -> tuple[str, ...]:
    """Names of the figures of a model: those that its preset names, else all of its kind."""
    return model.display.figures or tuple(name for name, drawing in FIGURES.items() if drawing.kind == model.kind)

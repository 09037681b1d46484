"""Results in, charts out: one figure a file, one definition for page, SVG, PNG and PDF."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from ident.custom.definition import preset_with
from ident.diagnosis.result import Diagnosis
from ident.errors import Unusable
from ident.figures.choose import KINDS, Option
from ident.figures.drawing import Drawing
from ident.figures.frame import unchecked
from ident.figures.ladder import ladder
from ident.figures.look import look
from ident.figures.profile_likelihood import profile_likelihood
from ident.figures.render import MEDIA, AltairChart, Chart, render, shown
from ident.figures.side_by_side import side_by_side
from ident.figures.study import Study
from ident.fit.result import FitResult
from ident.matrix import Actuator
from ident.presets import Preset
from ident.words.arguments import of_kind
from ident.words.nearest import did_you_mean
from ident.words.titles import title

__all__ = [
    "FIGURES", "MEDIA", "AltairChart", "Chart", "Study", "figure", "figures_for", "figures_of", "ladder", "look",
    "of_diagnosis", "profile_likelihood", "render", "shown", "side_by_side",
]  # fmt: skip

_FILES = (
    "residual_map",
    "bode",
    "time",
    "residual_curve",
    "residual_correlation",
    "sensitivity",
    "evolution",
    "starts",
    "pressure_loop",
    "frequency_characteristics",
    "speed_characteristic",
    "acceptance_sheet",
)
"""Each with one figure, in the order of the tabs of a page."""
_DRAWINGS: tuple[Drawing, ...] = tuple(getattr(import_module(f"ident.figures.{file}"), file.upper()) for file in _FILES)
FIGURES = {drawing.name: drawing for drawing in _DRAWINGS}


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
        raise Unusable("unknown-figure", f"no figure {name!r}", "figure", did_you_mean(name, names))
    known = FIGURES[name].options
    for option in options:
        if option not in known:
            raise Unusable(
                "unknown-option",
                f"no option {option!r}",
                f"figure {name}",
                did_you_mean(option, (*known, "theme", "share")),
            )
    for option, value in options.items():
        of_kind(f"figure {name}", option, value, KINDS.get(option, Option))
    with unchecked():
        return FIGURES[name].draw(study, look(theme, share), options)


def of_diagnosis(
    found: Diagnosis, name: str, actuator: Actuator, theme: str = "light", share: float = 1.0, **options: Any
) -> Chart:  # fmt: skip
    """The figure of a diagnosis: its ladder, the error with each effect added. Raises Unusable for any other."""
    if name != "ladder" or options:
        what = f"no option {next(iter(options))!r}" if options else f"no figure {name!r} of a diagnosis"
        raise Unusable("unknown-figure", what, "figure", "use ladder, or give the fit")
    steps = [
        (title(rung.added or "") or found.model, rung.error.get("fit"), rung.error.get("verify"))
        for rung in found.ladder
    ]
    return ladder(steps, found.noise_floor.get("fit"), actuator, look(theme, share))


def figures_of(fit: FitResult) -> tuple[str, ...]:
    """Names of the figures that a fit has: those of its model, of a search as far as it kept them."""
    model = preset_with(fit.model)
    kept = {"evolution": model.kind == "chain" or fit.evolution, "starts": fit.starts and fit.starts.errors}
    return tuple(name for name in figures_for(model) if kept.get(name, True))


def figures_for(model: Preset) -> tuple[str, ...]:
    """Names of the figures of a model: those that its preset names, else all of its kind."""
    return model.display.figures or tuple(name for name, drawing in FIGURES.items() if drawing.of == model.kind)

"""What a reader may choose about each figure of a fit."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from app.pages.run_view import specimen_of
from ident.custom.definition import preset_with
from ident.figures import FIGURES, Study, figures_of
from ident.figures.drawing import Choices, Drawing, Offer, OfferedRun
from ident.figures.options import CONDITIONS, OTHER, USE
from ident.fit.result import FitResult
from ident.presets import preset
from schemas.matrix import RunView

MAP, PROFILE = "residual-map", "profile"


@dataclass(frozen=True)
class Field:
    """One option of a figure: a list of (value, text), or a free number where there are no choices."""

    name: str
    label: str
    choices: Choices = ()


@dataclass(frozen=True)
class FigureForm:
    """One figure with its options; `picked` are those that it takes from what is picked out for all figures.

    `share` of its usual width is as wide as its place beside the map. `by_job` says that a job has to make it first.
    """

    name: str
    title: str
    fields: tuple[Field, ...]
    picked: tuple[str, ...] = ()
    share: float = 0.76
    by_job: bool = False


def forms(runs: Sequence[RunView], fit: FitResult) -> tuple[FigureForm, ...]:
    """The figures that this fit has, in the order of the tabs, each with the fields that its options have."""
    offer = Offer(fit, tuple(map(_offered, runs)))
    drawings = [FIGURES[name] for name in figures_of(fit) if name != "evolution" or fit.evolution]
    return tuple(
        FigureForm(
            drawing.name,
            drawing.title,
            tuple(_fields(drawing, offer)),
            tuple(option.name for option in drawing.options if option.picked),
            drawing.share,
        )
        for drawing in drawings
    )


_OF_RUNS = {option.name for option in (USE, *CONDITIONS)}


def overlaid(runs: Sequence[RunView], fits: Sequence[FitResult]) -> tuple[FigureForm, ...]:
    """The figures that show all of these fits, each of one run, with their fields."""
    named = [set(figures_of(fit)) for fit in fits]
    return tuple(
        replace(form, fields=tuple(field for field in form.fields if field.name not in _OF_RUNS))
        for form in forms(runs, fits[0])
        if all(form.name in names for names in named) and OTHER in FIGURES[form.name].options
    )


def _fields(drawing: Drawing[Study], offer: Offer) -> Iterator[Field]:
    """A field for each option that is offered: a free number, or where there is something to choose."""
    for option in drawing.options:
        choices = option.choices(offer) if option.choices else ()
        if option.label and (option.choices is None or len(choices) > 1):
            yield Field(option.name, option.label, choices)


def _offered(run: RunView) -> OfferedRun:
    return OfferedRun(run.use, run.gain, run.amplitude, run.units.get("command", "1"), specimen_of(run))


def profile_form(fit: FitResult) -> FigureForm | None:
    """The profile likelihood of each parameter that was searched; None where there is none."""
    searched = tuple(name for name in fit.searched if name in fit.parameters and not fit.parameters[name].fixed)
    if preset(fit.model).kind != "chain" or fit.window is not None or not searched:
        return None
    choices = tuple((name, f"{name}: {fit.parameters[name].meaning}") for name in searched)
    by_job = not preset_with(fit.model, fit.effects, fit.settings.get("custom", ())).is_linear
    return FigureForm(PROFILE, "Profile likelihood", (Field("parameter", "Parameter", choices),), by_job=by_job)

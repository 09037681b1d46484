"""What a reader may choose about each figure of a fit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from app.pages.run_view import specimen_of
from ident.bench.smoothing import METHODS as SMOOTHINGS
from ident.custom.definition import preset_with
from ident.figures import FIGURES, figures_of, words
from ident.fit.result import FitResult
from ident.presets import preset
from ident.residuals.views import views
from ident.words.uses import runs as data_runs
from schemas.matrix import RunView

Choices = tuple[tuple[str, str], ...]
MAP, PROFILE = "residual-map", "profile"
PICKED = ("run", "low", "high")


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


_SHARES = {MAP: 0.66, "bode": 0.79, "time": 0.69, "residual-curve": 0.63, "sensitivity": 0.62, "evolution": 0.63}


def forms(runs: Sequence[RunView], fit: FitResult) -> tuple[FigureForm, ...]:
    """The figures that this fit has, in the order of the tabs, each with the fields that its options have."""
    fields = {
        MAP: _conditions(runs),
        "bode": _bode(runs),
        "time": (Field("start", "Start (s)"), Field("seconds", "Length (s)")),
        "residual-curve": (Field("view", "Curve", _views(fit)), *_conditions(runs)),
        "evolution": _evolution(fit),
        "speed-characteristic": (
            Field("smoothing", "Smoothing", (("", SMOOTHINGS[0]), *((m, m) for m in SMOOTHINGS[1:]))),
        ),
    }
    drawings = [FIGURES[name] for name in figures_of(fit) if name != "evolution" or fit.evolution]
    return tuple(
        FigureForm(
            drawing.name, drawing.title, fields.get(drawing.name, ()),
            tuple(name for name in PICKED if name in drawing.options), _SHARES.get(drawing.name, 0.76),
        )
        for drawing in drawings
    )  # fmt: skip


def profile_form(fit: FitResult) -> FigureForm | None:
    """The profile likelihood of each parameter that was searched; None where there is none."""
    searched = tuple(name for name in fit.searched if name in fit.parameters and not fit.parameters[name].fixed)
    if preset(fit.model).kind != "chain" or fit.window is not None or not searched:
        return None
    choices = tuple((name, f"{name}: {fit.parameters[name].meaning}") for name in searched)
    by_job = not preset_with(fit.model, fit.effects, fit.settings.get("custom", ())).is_linear
    return FigureForm(PROFILE, "Profile likelihood", (Field("parameter", "Parameter", choices),), by_job=by_job)


def _bode(runs: Sequence[RunView]) -> tuple[Field, ...]:
    first = "verify" if any(run.use == "verify" for run in runs) else "fit"
    others = tuple((use, data_runs(use)) for use in ("fit",) if first == "verify")
    gains = _stated(runs, lambda run: run.gain, words.gain)
    units = {run.units.get("command", "1") for run in runs}
    unit = units.pop() if len(units) == 1 else "1"
    amplitudes = _stated(runs, lambda run: run.amplitude, lambda size: words.amplitude(size, unit))
    ordered = sorted(runs, key=lambda run: (run.mass or 0.0, run.stiffness or 0.0))
    specimens = dict.fromkeys(words.specimen(specimen_of(run)) for run in ordered if run.mass is not None)
    offered = (
        Field("use", "Runs", (("", data_runs(first)), *others, ("all", "all runs"))),
        Field("kp", "Gain", (("", "any"), *gains)),
        Field("amplitude", "Amplitude, RMS", (("", "any"), *amplitudes)),
        Field("specimen", "Specimen", (("", "any"), *((text, text) for text in specimens))),
        Field("axis", "Frequency axis", (("log", "logarithmic"), ("linear", "linear"))),
    )
    return tuple(field for field in offered if len(field.choices) > 1)


def _conditions(runs: Sequence[RunView]) -> tuple[Field, ...]:
    """The choices of a Bode plot, for figures that by themselves show many runs."""
    return tuple(field for field in _bode(runs) if field.name in ("kp", "amplitude", "specimen"))


def _views(fit: FitResult) -> Choices:
    return (("", "those that explain most"), *((view.name, view.name) for view in views(preset(fit.model))))


def _stated(runs: Sequence[RunView], of: Callable[[RunView], float | None], text: Callable[[float], str]) -> Choices:
    """The stated values in numeric order, as query and as words."""
    numbers = sorted({number for run in runs if (number := of(run)) is not None})
    return tuple((f"{number:.6g}", text(number)) for number in numbers)


def _evolution(fit: FitResult) -> tuple[Field, ...]:
    if len(fit.searched) < 2:
        return ()
    names = (("", "default"), *((name, name) for name in fit.searched))
    return (Field("x", "Across", names), Field("y", "Up", names))

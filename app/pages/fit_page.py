"""Everything that the page of a finished fit shows."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from markupsafe import Markup

from app.fits.objections import FAR
from app.fits.rows import Determined, ErrorRow, ParameterRow, combination_rows, error_rows, parameter_rows
from app.fits.service import Stored
from app.own_effects.own_effect import OwnEffect, usable_on
from app.pages.chain_view import Drawing, drawing
from app.pages.diagnosis_view import MissingView
from app.pages.figure_forms import MAP, FigureForm, forms, profile_form
from app.pages.job_view import settings_facts
from app.pages.ladder_view import Step, steps
from app.pages.matrix_view import counted
from app.pages.next_step_view import Next
from app.pages.own_effects_view import Keeping, KeptRow, keeping, kept_rows
from app.pages.run_view import Conditions, conditions
from app.parameters.error import error_of
from ident.custom.definition import HANDED_ON, preset_with
from ident.equations.equation import Equation
from ident.equations.mathml import mathml
from ident.fit.result import FitResult, Undetermined
from ident.preprocessing.pipeline import outcome_sentences
from ident.presets import Preset, preset
from ident.run import USES
from ident.words.engineering import quantity
from ident.words.error import ErrorOf, error_in_print, errors_line
from ident.words.percent import percent_in_print
from ident.words.titles import data, with_effects
from schemas.annotation import AnnotationView
from schemas.deletion import DeletionView
from schemas.fit import LadderView
from schemas.matrix import MatrixView
from schemas.parameters import ParameterSetView


@dataclass(frozen=True)
class FittedRun:
    """A run with its error and offset, fractions; the error also as it is read."""

    run: Conditions
    error: float
    offset: float
    said: ErrorOf


@dataclass(frozen=True)
class FitPageView:
    """What the fit page shows.

    `places` are those of the model with the signal that each hands on, `again` what queues the same fit, as JSON.
    """

    id: str
    serial: str
    matrix: str
    newer: str | None
    parent: str | None
    title: str
    citation: str
    method: str
    seed: int
    made: str
    approved_at: str | None
    current: bool
    parameters: tuple[ParameterRow, ...]
    errors: tuple[ErrorRow, ...]
    combinations: tuple[Determined, ...]
    undetermined: tuple[Undetermined, ...]
    notes: tuple[str, ...]
    runs: tuple[FittedRun, ...]
    chain: Drawing
    map: FigureForm | None
    figures: tuple[FigureForm, ...]
    profile: FigureForm | None
    ended_early: bool
    next: Next
    grade: tuple[str, str] | None
    conditional: bool
    objections: tuple[str, ...]
    headline: str
    equations: tuple[tuple[str, str, Markup], ...]
    facts: tuple[tuple[str, str], ...]
    missing: MissingView
    ladder: tuple[Step, ...]
    places: tuple[tuple[str, str], ...]
    again: str
    findings: str
    worst: str
    on_bench: bool
    free_run: str
    aic: str
    others: tuple[tuple[str, str], ...]
    kept: tuple[KeptRow, ...]
    keeping: tuple[Keeping, ...]
    written: AnnotationView
    deletion: DeletionView


def fit_page(
    stored: Stored,
    matrix: MatrixView,
    lacks: MissingView,
    ladder: LadderView,
    step: Next,
    objections: tuple[str, ...],
    others: Iterable[ParameterSetView] = (),
    newer: str | None = None,
    kept: Sequence[OwnEffect] = (),
    written: AnnotationView | None = None,
    deletion: DeletionView | None = None,
) -> FitPageView:
    """The page of a fit of this matrix; `others` are fits of the same actuator, to compare it with.

    `step` is what to do next, `objections` speak against an approval without a reason. `newer` is the newest revision
    of the matrix, None where it is this one; `kept` are the lab's own effects.
    """
    fit = stored.found
    model = preset_with(fit.model, fit.effects, fit.settings.get("custom", ()))
    known = {run.id: run for run in matrix.runs}
    figures = forms(matrix.runs, fit)
    return FitPageView(
        id=stored.id,
        serial=stored.serial,
        matrix=stored.matrix,
        newer=newer,
        parent=stored.parent,
        title=with_effects(model.title, fit.effects),
        citation=model.citation,
        method=fit.method,
        seed=fit.seed,
        made=stored.created_at,
        approved_at=stored.approved_at,
        current=stored.current,
        parameters=parameter_rows(fit),
        errors=error_rows(fit),
        combinations=combination_rows(fit),
        undetermined=fit.undetermined,
        notes=(*fit.notes, *outcome_sentences(fit.preprocessing, fit.notes)),
        runs=tuple(
            FittedRun(conditions(known[run.id]), run.error, run.offset, run.words)
            for run in fit.runs
            if run.id in known
        ),
        chain=drawing(fit),
        map=next((figure for figure in figures if figure.name == MAP), None),
        figures=tuple(figure for figure in figures if figure.name != MAP),
        profile=profile_form(fit),
        ended_early=fit.ended_early,
        next=step,
        grade=_grade(step, objections),
        conditional=_conditional(fit),
        objections=objections,
        headline=_headline(fit),
        equations=tuple((line.place, line.meaning, Markup(mathml(line.text))) for line in _equations(model)),
        facts=_facts(fit),
        missing=lacks,
        ladder=steps(ladder),
        places=tuple(_places(model)),
        findings=counted(serious := [entry for entry in matrix.findings if entry.severity != "note"]),
        worst="fault" if any(entry.severity == "fault" for entry in serious) else "doubt",
        others=tuple((other.id, other_fit(other)) for other in others if other.id != stored.id),
        again=json.dumps(fit_request(fit, stored.id)),
        on_bench=preset(fit.model).kind == "bench",
        free_run=_free_run(fit),
        aic="" if fit.aic is None else f"{fit.aic:.6g}".replace("-", "\u2212"),
        kept=tuple(kept_rows(usable_on(kept, fit.model), fit.effects)),
        keeping=tuple(keeping(lacks, kept)),
        written=written or AnnotationView(),
        deletion=deletion or DeletionView(fit=stored.id, serial=stored.serial),
    )


def _headline(fit: FitResult) -> str:
    """The error on each use of runs in a line, with what a reader must know of it."""
    return f"Error {errors_line({use: fit.error_of(use) for use in USES}, percent_in_print)}"


def _grade(step: Next, objections: Sequence[str]) -> tuple[str, str] | None:
    """Good or not, as the state that a page marks and its words; None where nothing is known of it."""
    if step.grade == "good" and objections:
        return "doubt", "Check before approval."
    return {"good": ("approved", "Good fit."), "poor": ("doubt", "Not good yet.")}.get(step.grade)


def _conditional(fit: FitResult) -> bool:
    """Whether the standard errors hold only if the model is right: its error is far above the noise floor."""
    error, floor = fit.error_of("fit").error, fit.noise_floor.get("fit")
    return error is not None and bool(floor) and error > FAR * (floor or 0.0)


def _free_run(fit: FitResult) -> str:
    """Of a fit over windows: how far the free run's errors hang on the parameters."""
    if fit.window is None or not fit.window.free_run:
        return ""
    ends = [f"{' to '.join(map(error_in_print, e))} on {data(use)}" for use, e in fit.window.free_run.items()]
    return (
        "A free run accumulates disturbances. Within the standard errors of the parameters its error is "
        f"{', '.join(ends)}. Over windows the model restarts from the measurement."
    )


def _places(model: Preset) -> Iterator[tuple[str, str]]:
    """The places of a model, each with the signal that a line without a name redefines, where the model has it."""
    for place in dict.fromkeys(stage.place for stage in model.chain.stages):
        signal = HANDED_ON[place]
        yield place, signal if signal in model.chain.units else ""


def other_fit(fit: ParameterSetView) -> str:
    """Another fit in a line: when, which model, how good."""
    effects = dict.fromkeys(name.partition(".")[0] for name in fit.parameters if "." in name)
    made = fit.created_at[:16].replace("T", " ")
    return f"{made} · {with_effects(fit.model, effects)} · {error_of(fit, 'fit').in_print()}"


def fit_request(fit: FitResult, parent: str) -> dict[str, Any]:
    """The request of a fit with the same settings, which comes from this one."""
    given = dict(fit.settings)
    names = ("method", "bounds", "options", "load")
    return {
        "model": fit.model,
        "effects": list(fit.effects),
        "seed": fit.seed,
        "parent": parent,
        **{name: given[name] for name in names if name in given},
        "set": given.get("fixed", {}),
        "custom": [own for own in given.get("custom", ()) if own["name"] in fit.effects],
    }


def _equations(model: Preset) -> Iterator[Equation]:
    """The chain's equations, each place with its effects behind it, as they are written."""
    for stage in model.chain.stages:
        yield from stage.equations
        for effect in model.effects:
            if effect.place == stage.place:
                yield from effect.equations


def _facts(fit: FitResult) -> tuple[tuple[str, str], ...]:
    return (
        *settings_facts(dict(fit.settings)),
        ("Evaluations", f"{fit.evaluations:,}".replace(",", "\u2009")),
        *((("Starts", str(fit.starts)),) if fit.starts else ()),
        ("Computing time", quantity(fit.seconds, "s")),
        ("Version", fit.version),
        ("Data, SHA-256", fit.data_hash),
    )

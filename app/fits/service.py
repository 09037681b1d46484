"""Fits: queue, look, compare."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from sqlalchemy.orm import Session

from app.context import Context
from app.errors import missing
from app.fits import repository
from app.fits.objections import of_fit
from app.jobs import service as jobs
from app.matrices import service as matrices
from app.own_effects.naming import with_kept
from app.parameters.error import error_of
from app.tables import FitRow
from ident.comparison.side_by_side import Change, SideBySide, of_fits
from ident.fit.choices import Choices
from ident.fit.choices import settings_of as chosen_settings
from ident.fit.identification import check_settings
from ident.fit.result import FitResult
from ident.fit.settings import GENERAL, Settings
from ident.plain import written
from ident.preprocessing import off_steps, screen
from ident.presets.suitable_models import in_question, is_assumed_loop
from ident.residuals.budget import Budget, budget
from ident.residuals.survey import survey
from ident.words.error import ErrorOf
from ident.workflows import compare
from schemas.fit import (
    Chosen,
    ComparedRun,
    ComparisonView,
    FitColumn,
    FitRequest,
    FitView,
    JobView,
    RunBeside,
    SideBySideView,
)
from schemas.matrix import MatrixView
from schemas.result import EstimateView, FitResultView


@dataclass(frozen=True)
class Stored:
    """A fit, and where it belongs."""

    id: str
    matrix: str
    serial: str
    parent: str | None
    created_at: str
    approved_at: str | None
    current: bool
    found: FitResult


@dataclass(frozen=True)
class Yardstick:
    """What the error of a fit on runs to fit is held against: its noise floor, and the error of the fit before it."""

    parent: str | None = None
    before: ErrorOf = field(default_factory=lambda: ErrorOf(None))
    floor: float | None = None


def submit(context: Context, request: FitRequest, job: str, who: str) -> JobView:
    """Queue a fit under the id decided for its job. It is recorded before this returns: nothing can lose it."""
    matrix = matrices.find(context, request.matrix)
    if request.parent is not None:
        find(context, request.parent)
    settings = settings_of(with_kept(context, request), matrices.view(matrix))
    return queue(context, job, matrix.id, settings, request.parent, who)


def queue(context: Context, job: str, matrix: str, settings: Settings, parent: str | None, who: str) -> JobView:
    """Record and queue the job of a fit. Raises Unusable where its settings cannot be."""
    check_settings(settings)
    return jobs.record(context, job, matrix, settings.to_json(), parent, "fit", who)


def settings_of(request: Chosen, matrix: MatrixView | None, candidates: bool = False) -> Settings:
    """The library's settings: numbers are SI, text may carry a unit. Raises Unusable.

    With `candidates` bounds and values may be of effects, too, that a diagnosis may add to the model.
    """
    named = request.model or _model(request, matrix)
    if not named:
        return Settings(
            model="",
            method=request.method,
            seed=request.seed,
            load=request.load,
            options=request.options,
            budget=request.budget,
            preprocessing=off_steps(request.preprocessing),
        )
    return chosen_settings(
        Choices(
            model=named,
            effects=request.effects,
            custom=request.custom,
            method=request.method,
            seed=request.seed,
            bounds=request.bounds,
            fixed=request.set,
            load=request.load,
            options=request.options,
            budget=request.budget,
            preprocessing=request.preprocessing,
        ),
        candidates=candidates,
    )


def _model(request: Chosen, matrix: MatrixView | None) -> str:
    """The model where none is named: "" where the fit is to choose it, the likeliest where something belongs to it."""
    if matrix is None:
        return Settings().model
    if matrix.machine:
        return matrix.machine
    likeliest, *others = in_question(matrix.runs, oil=matrix.states_oil)
    belongs = request.effects or request.custom or request.bounds or request.set or request.method not in GENERAL
    usual = not others and likeliest.name == Settings().model and not is_assumed_loop(likeliest, matrix.runs)
    return likeliest.name if belongs or usual else ""


def yardsticks(context: Context, fits: Sequence[str]) -> dict[str, Yardstick]:
    """That of each of these fits."""
    with context.sessions() as session:
        found = repository.floors(session, fits)
    return {
        fit: Yardstick(parent, error_of(before, "fit"), (floor or {}).get("fit"))
        for fit, parent, before, floor in found
    }


def find(context: Context, fit_id: str) -> FitRow:
    """The record of a fit; raises Failure 404."""
    with context.sessions() as session:
        return recorded(session, fit_id)


def recorded(session: Session, fit_id: str) -> FitRow:
    """The same within a transaction."""
    found = repository.fit(session, fit_id)
    if found is None:
        raise missing("fit", fit_id)
    return found


def against(context: Context, fit_id: str) -> tuple[str, ...]:
    """What speaks against approving a fit, each a clause; raises Failure 404."""
    with context.sessions() as session:
        return of_fit(session, recorded(session, fit_id))


def get(context: Context, fit_id: str) -> FitView:
    """A fit by id as it is sent, with the history of its search; raises Failure 404."""
    row, result = _whole(context, fit_id)
    return FitView(
        id=row.id,
        matrix=row.matrix,
        serial=row.serial,
        parent=row.parent,
        created_at=row.created_at,
        approved_at=row.set.approved_at,
        current=row.set.current,
        result=FitResultView(**result),
        objections=list(against(context, fit_id)),
    )


def stored(context: Context, fit_id: str) -> Stored:
    """A fit by id, with the history of its search; raises Failure 404."""
    row, result = _whole(context, fit_id)
    return Stored(
        id=row.id,
        matrix=row.matrix,
        serial=row.serial,
        parent=row.parent,
        created_at=row.created_at,
        approved_at=row.set.approved_at,
        current=row.set.current,
        found=FitResult.from_json(result),
    )


def _whole(context: Context, fit_id: str) -> tuple[FitRow, dict[str, Any]]:
    """The record of a fit, and its result with the history of its search; raises Failure 404."""
    row = find(context, fit_id)
    with context.sessions() as session:
        return row, repository.whole_result(session, context.storage, row)


def comparison(context: Context, fit_id: str) -> ComparisonView:
    """The fit against every run of its matrix, recomputed from the samples."""
    row = find(context, fit_id)
    found = compare(matrices.load(context, row.matrix), FitResult.from_json(row.result))
    runs = [ComparedRun(**record) for record in found.records()]
    return ComparisonView(
        fit=fit_id,
        error=found.error,
        offset=found.offset,
        error_with_mean=found.error_with_mean,
        rmse=found.rmse,
        fit_percent=found.fit_percent,
        runs=runs,
        **survey(found).to_json(),
    )


def beside(context: Context, fit_id: str, others: Sequence[str]) -> SideBySide:
    """A fit and others, with the errors that they were stored with. Raises Failure 404, Unusable."""
    rows = [find(context, one) for one in (fit_id, *others)]
    return of_fits([FitResult.from_json(row.result) for row in rows], [row.serial for row in rows])


def side_by_side(context: Context, fit_id: str, others: Sequence[str]) -> SideBySideView:
    """The same as it is sent."""
    found = beside(context, fit_id, others)
    first = found.columns[0]
    fits = [
        FitColumn(
            fit=name,
            name=one.name,
            serial=one.serial,
            model=one.fit.model,
            effects=list(one.fit.effects),
            error=dict(one.error),
            ratio={use: Change(first.error.get(use), error).ratio for use, error in one.error.items()},
            points={use: Change(first.error.get(use), error).points for use, error in one.error.items()},
            parameters={key: EstimateView(**entry) for key, entry in written(one.fit.parameters).items()},
        )
        for name, one in zip((fit_id, *others), found.columns, strict=True)
    ]
    runs = [
        RunBeside(
            id=run,
            use=use,
            error={one.name: one.runs.get(run) for one in found.columns},
            ratio={one.name: Change(first.runs.get(run), one.runs.get(run)).ratio for one in found.columns},
            points={one.name: Change(first.runs.get(run), one.runs.get(run)).points for one in found.columns},
        )
        for run, use in found.uses.items()
    ]
    return SideBySideView(fits=fits, runs=runs)


def budget_of(context: Context, fit_id: str) -> Budget:
    """What the error on the runs to fit is made of. Raises Unusable where the model is unstable at every run."""
    row = find(context, fit_id)
    fit = FitResult.from_json(row.result)
    matrix = screen(matrices.load(context, row.matrix), fit.settings.get("preprocessing", {}))
    fitted = replace(matrix, runs=matrix.of_use("fit") or matrix.runs)
    return budget(compare(fitted, fit))

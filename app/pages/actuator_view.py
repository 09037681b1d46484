"""Actuators and their fits as rows of tables."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from app.pages.sparkline import ERROR, Drift, drift
from app.parameters.error import error_of
from ident.errors import Unusable
from ident.fit import sheet_quantity
from ident.presets import preset
from ident.rig.conditions import CONDITIONS, PREFIX
from ident.words.engineering import quantity
from ident.words.error import ErrorOf
from ident.words.titles import symbol, title
from schemas.annotation import AnnotationView
from schemas.fit import JobView
from schemas.parameters import ActuatorView, ParameterSetView


@dataclass(frozen=True)
class ActuatorRow:
    """An actuator with its current set, or without one its newest."""

    serial: str
    name: str
    batch: str
    state: str
    state_text: str
    model: str
    error_fit: float | None
    error_verify: float | None
    said_fit: ErrorOf
    said_verify: ErrorOf
    parameters: tuple[tuple[str, str], ...]
    drift: Drift | None
    made: str | None


@dataclass(frozen=True)
class FitRow:
    """A fit or the job that is to make it; `done` where it is a fit, and can be compared."""

    id: str
    state: str
    state_text: str
    model: str
    method: str
    seed: str
    error_fit: float | None
    error_verify: float | None
    said_fit: ErrorOf
    said_verify: ErrorOf
    made: str
    done: bool = False
    name: str = ""
    tags: tuple[str, ...] = ()


def actuator_row(
    actuator: ActuatorView,
    newest: ParameterSetView | None,
    job: JobView | None,
    approved: Sequence[ParameterSetView] = (),
    drifting: str = ERROR,
) -> ActuatorRow:
    """The row of an actuator; `job` is one that waits or runs for it, `drifting` what is followed over `approved`."""
    shown = actuator.current or newest
    state, text = _state(actuator, newest, job)
    return ActuatorRow(
        serial=actuator.serial,
        name=actuator.name,
        batch=actuator.batch,
        state=state,
        state_text=text,
        model=shown.model if shown else "",
        error_fit=shown.error_fit if shown else None,
        error_verify=shown.error_verify if shown else None,
        said_fit=error_of(shown, "fit"),
        said_verify=error_of(shown, "verify"),
        parameters=_parameters(shown) if shown else (),
        drift=drift(approved, drifting, drifting if shown is None else _symbol(shown.model, drifting)),
        made=newest.created_at if newest else None,
    )


def _state(actuator: ActuatorView, newest: ParameterSetView | None, job: JobView | None) -> tuple[str, str]:
    if job is not None:
        total, done = job.progress.total, job.progress.done
        share = f", {100 * done / total:.0f} %" if total and job.state == "running" else ""
        return job.state, f"{job.state}{share}"
    if actuator.current is not None:
        return "approved", "approved"
    return ("succeeded", "fitted, not approved") if newest is not None else ("queued", "no fit yet")


def followed(approved: Mapping[str, Sequence[ParameterSetView]]) -> tuple[tuple[str, str], ...]:
    """What can be followed over these sets, as query and as words: the error first."""
    sets = [entry for each in approved.values() for entry in each]
    symbols = {name: _symbol(entry.model, name) for entry in sets for name in entry.parameters}
    return ((ERROR, "error, validation data"), *symbols.items())


def drifts(sets: Sequence[ParameterSetView], model: str) -> tuple[tuple[str, Drift], ...]:
    """The error and each parameter that the approved sets of one model have had at least twice."""
    alike = [entry for entry in sets if entry.model == model]
    names = dict.fromkeys(name for entry in alike for name in entry.parameters)
    symbols = {ERROR: "error", **{name: _symbol(model, name) for name in names}}
    found = ((symbol, drift(alike, name, symbol)) for name, symbol in symbols.items())
    return tuple((symbol, each) for symbol, each in found if each is not None)


def _parameters(shown: ParameterSetView) -> tuple[tuple[str, str], ...]:
    """Those of the model: a set also holds its acceptance sheet and the conditions of its test."""
    return tuple(
        (_symbol(shown.model, name), quantity(entry.value, entry.unit))
        for name, entry in shown.parameters.items()
        if not name.startswith((sheet_quantity.PREFIX, PREFIX))
    )


def _symbol(model: str, name: str) -> str:
    """The symbol of the literature, behind the name of its effect; the plain name where neither is known."""
    if (condition := CONDITIONS.get(name.removeprefix(PREFIX))) and name.startswith(PREFIX):
        return condition.title
    effect, dot, _ = name.partition(".")
    try:
        written = symbol(name, preset(model, (effect,) if dot else ()).parameter(name).symbol)
        return f"{title(effect)} {written}" if dot else written
    except Unusable:
        return name


def fit_rows(
    jobs: Iterable[JobView], sets: Iterable[ParameterSetView], written: Mapping[str, AnnotationView]
) -> tuple[FitRow, ...]:
    """A row a job, with the errors of the set that it made, and the name and tags that are written on it."""
    made = {entry.id: entry for entry in sets}
    return tuple(_fit_row(job, made.get(job.id), written.get(job.id, AnnotationView())) for job in jobs)


def _fit_row(job: JobView, made: ParameterSetView | None, written: AnnotationView) -> FitRow:
    state, text = _fit_state(job.state, made)
    return FitRow(
        id=job.id,
        state=state,
        state_text=text,
        model=made.model if made else job.settings.model,
        method=job.settings.method,
        seed=str(job.settings.seed),
        error_fit=made.error_fit if made else None,
        error_verify=made.error_verify if made else None,
        said_fit=error_of(made, "fit"),
        said_verify=error_of(made, "verify"),
        made=job.created_at,
        done=made is not None,
        name=written.name,
        tags=tuple(written.tags),
    )


def _fit_state(state: str, made: ParameterSetView | None) -> tuple[str, str]:
    if made is None or state != "succeeded":
        return state, state
    if made.current:
        return "approved", "approved, current"
    return ("succeeded", "approved earlier") if made.approved_at else ("succeeded", "done")

"""A diagnosis as the work of a job: in one piece, which a kill makes run again from its beginning."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from sqlalchemy.orm import Session

from app.diagnoses import repository
from app.fits import repository as fits
from app.fits.history import put_apart
from app.jobs.work import InOnePiece, Kind, MadeSoFar, State, Task
from app.own_effects.own_effect import OwnEffect, usable_on
from app.tables import JobRow
from ident.custom.definition import read_effect
from ident.diagnosis.result import Diagnosis
from ident.diagnosis.stages import FURTHER
from ident.errors import Cancelled, TimeIsUp, Unusable
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.plain import read
from ident.progress import Report
from ident.time_budget import TimeBudget
from ident.workflows import diagnose, identify

OWN = ("max_effects", "time", "reseed", "propose", "own")
"""What the settings of a diagnosis hold beside those of its fit."""


class DiagnosisWork(InOnePiece):
    """A diagnosis, and the fit that is made first where none is given."""

    def __init__(self, task: Task) -> None:
        self.task = task

    def finish(self, state: State) -> State:  # noqa: ARG002  nothing comes before it
        """The diagnosis, and the fit that was made for it."""
        chosen, matrix, report = self.task.settings, self.task.matrix, self.task.report
        budget = TimeBudget(chosen.get("time"))
        given = self.task.fit
        if given is None:
            settings = Settings.from_json({name: value for name, value in chosen.items() if name not in OWN})
            fit = _fitted(matrix, settings, report, budget)
        else:
            given = _with_asked(given, chosen)
            fit = given if chosen["reseed"] is None else _reseeded(given, chosen["reseed"])
        made, fit = fit, _beside_the_lab_s(fit, chosen.get("own", ()))
        own = tuple(read_effect(definition, model=fit.model) for definition in fit.settings.get("custom", ()))
        with_fit = None if given else put_apart(self.task.storage, made.to_json())

        def kept(so_far: Diagnosis) -> None:
            if FURTHER not in so_far.not_looked_at:  # the catalogue is through
                report(MadeSoFar("kept", 1, 1, made={"diagnosis": so_far.to_json(), "fit": with_fit}))

        found = diagnose(
            matrix,
            fit,
            most=chosen["max_effects"],
            custom=own,
            report=report,
            budget=budget,
            found=kept,
            propose=chosen.get("propose", False),
        )
        return {"diagnosis": found.to_json(), "fit": with_fit}


def _with_asked(fit: FitResult, chosen: Mapping[str, Any]) -> FitResult:
    """The given fit with the definitions to be ranked, and with what was asked of parameters of effects."""
    known = fit.with_custom(chosen.get("custom", ()))
    asked = {name: chosen[name] for name in ("bounds", "fixed") if name in chosen}
    return replace(known, settings={**known.settings, **asked})


def _fitted(matrix: Matrix, settings: Settings, report: Report, budget: TimeBudget) -> FitResult:
    """The fit that is made first. Raises Unusable where there is no time for it, Cancelled where it is stopped."""
    try:
        with budget.running():
            return identify(matrix, settings, report)
    except TimeIsUp:  # nothing is found before there is a fit
        if not budget.is_over:
            raise Cancelled from None
        what = f"{budget.seconds:g} s are over before a model is fitted"
        raise Unusable("no-time", what, "time", "give more, or a fit") from None


def _beside_the_lab_s(fit: FitResult, kept: Sequence[Mapping[str, Any]]) -> FitResult:
    """The fit with the lab's own effects that its model can take beside its own, which come first."""
    known = tuple(fit.settings.get("custom", ()))
    names = {definition["name"] for definition in known}
    entries = usable_on((read(OwnEffect, entry) for entry in kept), fit.model)
    more = [entry.definition for entry in entries if entry.name not in names]
    return fit.with_custom((*known, *more)) if more else fit


def _reseeded(fit: FitResult, seed: int) -> FitResult:
    return replace(fit, seed=seed, settings={**fit.settings, "seed": seed} if fit.settings else {})


def _keep(session: Session, job: JobRow, serial: str, made: State) -> None:
    """Store a diagnosis, in the place of what was known of it before, and the fit that was made for it, once."""
    known = repository.diagnosis(session, job.id)
    if known is not None:
        known.result = made["diagnosis"]
        return
    if made["fit"] is not None:
        fits.add_fit(session, job, made["fit"])
    repository.add(session, job, serial, made["diagnosis"])


DIAGNOSIS = Kind("diagnosis", DiagnosisWork, _keep)

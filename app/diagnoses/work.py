"""A diagnosis as steps for the queue: it is one step, which a kill makes run again from its beginning."""

from __future__ import annotations

from dataclasses import replace

from sqlalchemy.orm import Session, sessionmaker

from app.diagnoses import repository
from app.fits import repository as fits
from app.jobs.steps import State, Steps
from app.storage import Storage
from app.tables import JobRow
from ident.custom.definition import read_effect
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.workflows import diagnose, identify

OWN = ("max_effects", "reseed")
"""What the settings of a diagnosis hold beside those of its fit."""


class DiagnosisWork:
    """The steps of a diagnosis, and of the fit that it makes first where it was given none."""

    def __init__(self, sessions: sessionmaker[Session], storage: Storage) -> None:
        self.steps = Steps("diagnosis", sessions, storage)

    def begin(self, job: str) -> State:
        """Mark it as running."""
        return self.steps.step(job, lambda: {"done": True}, first=True)

    def advance(self, job: str, state: State) -> State:
        """Nothing: it is not searched in generations."""
        return self.steps.step(job, lambda: state)

    def finish(self, job: str, state: State) -> State:  # noqa: ARG002  the interface of all jobs
        """All of it; the state is the diagnosis, and the fit that was made for it."""
        return self.steps.step(job, lambda: self._diagnosed(job))

    def store(self, job: str, last: State) -> None:
        """Record the diagnosis with its fit, or how the job ended."""
        self.steps.store(job, last, _keep)

    def _diagnosed(self, job: str) -> State:
        row, matrix = self.steps.recorded(job)
        report, chosen = self.steps.reporter(job), row.settings
        given = self._given(row)
        if given is None:
            settings = Settings.from_json({name: value for name, value in chosen.items() if name not in OWN})
            fit = identify(matrix, settings, report)
        else:
            given = given.with_custom(chosen.get("custom", ()))
            fit = given if chosen["reseed"] is None else _reseeded(given, chosen["reseed"])
        own = tuple(read_effect(definition, model=fit.model) for definition in fit.settings.get("custom", ()))
        found = diagnose(matrix, fit, most=chosen["max_effects"], custom=own, report=report)
        return {"diagnosis": found.to_json(), "fit": None if given else fit.to_json()}

    def _given(self, row: JobRow) -> FitResult | None:
        if row.parent is None:
            return None
        with self.steps.sessions() as session:
            stored = fits.fit(session, row.parent)
        if stored is None:
            raise Unusable("no-such-fit", "the fit is not stored any more", row.parent, "start another diagnosis")
        return FitResult.from_json(stored.result)


def _reseeded(fit: FitResult, seed: int) -> FitResult:
    return replace(fit, seed=seed, settings={**fit.settings, "seed": seed} if fit.settings else {})


def _keep(session: Session, job: JobRow, serial: str, made: State) -> None:
    if repository.diagnosis(session, job.id) is not None:
        return
    if made["fit"] is not None:
        fits.add_fit(session, job, serial, made["fit"])
    repository.add(session, job, serial, made["diagnosis"])

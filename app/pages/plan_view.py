"""A test plan for a rig as the page shows it: the form, and what came of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from app.context import Context
from app.errors import missing
from app.fits import service as fits
from app.jobs import service as jobs
from app.pages.job_view import JobPageView, job_page
from app.plans import service as plans
from ident.fit.result import FitResult
from ident.planning.files import WRITERS
from ident.rig.limits import UNITS
from ident.words.engineering import quantity
from ident.words.number import plain
from ident.words.percent import percent_in_print
from schemas.plan import PlannedRunView, PlanView

LIMITS: Mapping[str, tuple[str, str]] = {
    "stroke": ("Stroke, end to end", "152.4 mm"),
    "speed": ("Speed", "0.5 m/s"),
    "acceleration": ("Acceleration", "30 m/s^2"),
    "force": ("Force", "9.8 kN"),
    "flow": ("Valve flow", "38 l/min"),
    "supply_pressure": ("Supply pressure", "207 bar"),
}
"""Fields of the form: label, and an example of what to write."""
OWN = """\
gains: [5, 10]
amplitudes: [0.5 mm, 2 mm]
specimens: [{mass: 0 kg}, {mass: 0.87 kg, stiffness: 36.3 kN/m}]
kinds: [blwn, {kind: sine, frequency: 5 Hz}]
verify: {gains: [7]}
seconds: 30 s
"""
"""What the field for an own program begins with."""


@dataclass(frozen=True)
class RunRow:
    """A run in words: amplitude, its share of that asked, share of the tightest limit."""

    id: str
    use: str
    amplitude: str
    scale: str
    share: str
    limit: str


@dataclass(frozen=True)
class PlanShown:
    """A plan: the runs that are refused (id, why, factor), those that are planned, what is to be said of it."""

    id: str
    program: str
    made: str
    limits: str
    refused: tuple[tuple[str, str, str], ...]
    runs: tuple[RunRow, ...]
    sentences: tuple[str, ...]


@dataclass(frozen=True)
class PlanPageView:
    """The form, filled with the limits of the fit's matrix; the plan that is shown, or the job that is to make it."""

    fit: str
    serial: str
    known: Mapping[str, str]
    shown: PlanShown | None
    job: JobPageView | None
    limits: Mapping[str, tuple[str, str]]
    example: str = OWN
    formats: tuple[str, ...] = tuple(WRITERS)


def plan_page(context: Context, fit: str, plan: str) -> PlanPageView:
    """The page for a fit, or for none, with a plan or its job. Raises Failure 404."""
    found = plans.made_as(context, plan) if plan else None
    job = _job(context, plan) if plan and found is None else None
    if job is not None and job.state == "succeeded":  # between the two looks
        found, job = plans.get(context, plan), None
    fit = fit or (found.fit if found else job.parent if job else None) or ""
    row = fits.find(context, fit) if fit else None
    actuator = FitResult.from_json(row.result).actuator if row is not None else None
    stated = actuator.rig_limits.stated if actuator is not None else {}
    if found is not None:
        stated = {name: value for name, value in found.limits.model_dump().items() if value is not None}
    known = {name: f"{value:.6g} {UNITS[name]}" for name, value in stated.items()}
    return PlanPageView(
        fit, row.serial if row is not None else "", known, None if found is None else _shown(found), job, LIMITS
    )


def _job(context: Context, plan: str) -> JobPageView:
    """The job that has not made a plan. Raises Failure 404."""
    job = jobs.get(context, plan)
    if job.kind != plans.KIND:
        raise missing("plan", plan)
    return job_page(job)


def _shown(found: PlanView) -> PlanShown:
    stated = {name: value for name, value in found.limits.model_dump().items() if value is not None}
    limits = ", ".join(f"{LIMITS[name][0].lower()} {quantity(value, UNITS[name])}" for name, value in stated.items())
    refused = tuple((one.id, one.why, "none" if one.factor is None else plain(one.factor, 3)) for one in found.refused)
    return PlanShown(
        found.id,
        found.program,
        found.created_at,
        limits or "none",
        refused,
        tuple(map(_row, found.runs)),
        tuple(found.sentences),
    )


def _row(run: PlannedRunView) -> RunRow:
    limit = LIMITS[run.limit][0].lower() if run.limit else "–"
    return RunRow(run.id, run.use, run.words, percent_in_print(run.scale), percent_in_print(run.share), limit)

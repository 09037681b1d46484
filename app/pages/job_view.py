"""Jobs and fits as rows of a table, and a job that has no result yet as a page."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ident.words.duration import duration, time_left_said
from ident.words.sentence import sentence
from ident.words.titles import title
from schemas.fit import JobProblem, JobView

_OPEN = ("queued", "running")
_PLACES = {"diagnosis": "#missing", "profile": "#profile", "hybrid simulation": "/use?simulation={job}#hybrid"}
_PLAN = "/plan?plan={job}#made"


@dataclass(frozen=True)
class JobPageView:
    """A job that waits, runs, or ended without a result; `at` is the page that shows it."""

    id: str
    kind: str
    parent: str | None
    at: str
    serial: str
    matrix: str
    state: str
    open: bool
    stage: str
    done: int
    total: int
    error: float | None
    expected: tuple[tuple[str, float], ...]
    added: tuple[tuple[str, float], ...]
    verdict: str
    problem: str
    facts: tuple[tuple[str, str], ...]
    made: str
    elapsed: str
    left: str


def job_page(job: JobView) -> JobPageView:
    """The page of a job."""
    return JobPageView(
        id=job.id,
        kind=job.kind,
        parent=job.parent,
        at=_at(job),
        serial=job.serial,
        matrix=job.matrix,
        state=job.state,
        open=job.state in _OPEN,
        stage=job.progress.stage or ("queued" if job.state == "queued" else "preparing the runs"),
        done=job.progress.done,
        total=job.progress.total,
        error=job.progress.error,
        expected=tuple((title(one.effect), one.error) for one in job.progress.expected),
        added=tuple((title(one.effect), one.error) for one in job.progress.added),
        verdict=job.progress.verdict,
        problem=_problem(job.problem),
        facts=settings_facts(job.settings.model_dump()),
        made=job.created_at,
        elapsed="" if job.elapsed is None else duration(job.elapsed),
        left=_left(job),
    )


def _left(job: JobView) -> str:
    """The time that a running job has left, in words; "" where it does not run."""
    if job.state != "running":
        return ""
    left = job.time_left
    return "not known yet" if left is None else time_left_said(left.seconds, left.lower, left.upper)


def _at(job: JobView) -> str:
    """The page that shows a job: that of its fit where it makes none; a plan has a page of its own."""
    if job.kind == "plan":
        return _PLAN.format(job=job.id)
    if job.parent is not None and job.kind in _PLACES:
        return f"/fits/{job.parent}{_PLACES[job.kind].format(job=job.id)}"
    return f"/fits/{job.id}"


def settings_facts(settings: dict[str, Any]) -> tuple[tuple[str, str], ...]:
    """What the user chose, as far as it is not empty."""
    names = ("model", "effects", "method", "seed", "budget", "bounds", "fixed", "load", "options", "max_effects",
             "time", "parameter", "case", "controller", "ground", "program")  # fmt: skip
    start = settings.get("start")
    of_search = () if not start or start["search"] else ("method", "seed", "options")
    chosen = ((name, settings.get(name)) for name in names if name not in of_search)
    facts = tuple(
        (title(name).capitalize(), _words(value)) for name, value in chosen if value not in (None, [], {}, "none")
    )
    return (*facts, ("Begins", f"where a {start['of']} ended")) if start else facts


def _words(value: Any) -> str:
    if isinstance(value, dict):
        return "; ".join(f"{name} {_words(entry)}" for name, entry in value.items())
    if isinstance(value, list | tuple):
        between = ", " if any(isinstance(entry, str) for entry in value) else " to "
        return between.join(map(_words, value))
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _problem(problem: JobProblem | None) -> str:
    """What, where and remedy as sentences."""
    if problem is None:
        return ""
    said = f"{problem.where}: {problem.detail}" if problem.where else problem.detail
    return f"{said}. {sentence(problem.remedy)}" if problem.remedy else f"{said}."

"""A fit is deleted whole, with all that was made of it, or not at all."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.tables import (
    AnnotationRow,
    ApprovalRow,
    Base,
    ControllerRow,
    DiagnosisRow,
    FitRow,
    HybridRow,
    JobRow,
    OwnEffectRow,
    PlanRow,
    ProfileRow,
    RecheckRow,
    RegressionRow,
)

API = "/api/v1"
SHORT = {"population": 20, "generations": 3, "elite": 2}


@pytest.fixture
def made(service, matrix) -> str:
    """A fit of few generations."""
    job = service.post(f"{API}/fits", json={"matrix": matrix, "options": SHORT}).json()["id"]
    assert '"state":"succeeded"' in service.get(f"{API}/jobs/{job}/events").text
    return str(job)


def store(service: Any, add: Callable[[Session, FitRow], None], fit: str) -> None:
    """Add rows that hang on a fit."""
    with service.app.state.context.sessions.begin() as session:
        add(session, session.get_one(FitRow, fit))


def everything(session: Session, fit: FitRow) -> None:
    """One of each that is made of a fit, and the job of a search for effects that failed."""
    of: dict[str, Any] = {"matrix": fit.matrix, "serial": fit.serial}
    session.add(ControllerRow(id="c" + fit.id, fit=fit.id, asked={}, result={}))
    session.flush()
    session.add_all(
        [
            DiagnosisRow(id="d" + fit.id, fit=fit.id, result={}, **of),
            HybridRow(id="h" + fit.id, fit=fit.id, controller="c" + fit.id, asked={}, result={}, records=b"", **of),
            ProfileRow(id="p" + fit.id, fit=fit.id, parameter="tau", result={}),
            PlanRow(id="t" + fit.id, fit=fit.id, result={}),
            AnnotationRow(fit=fit.id, tags=[]),
            JobRow(id="j" + fit.id, kind="diagnosis", state="failed", matrix=fit.matrix, parent=fit.id, settings={}),
        ]
    )


def left_of(service: Any, fit: str) -> dict[str, int]:
    """Rows in which the id of a fit, or that of something made of it, stands in any column of text."""
    found = {}
    with service.app.state.context.sessions() as session:
        for table in Base.metadata.sorted_tables:
            rows = session.execute(select(table)).all()
            count = sum(any(isinstance(value, str) and value.endswith(fit) for value in row) for row in rows)
            if count and table.name != "audit":
                found[table.name] = count
    return found


def test_a_fit_goes_with_all_that_was_made_of_it_and_its_data_stay(service, matrix, made):
    """No table names it any more but the audit; its page and its job are gone, too."""
    assert "Nothing was made of this fit" in service.get(f"/fits/{made}").text
    store(service, everything, made)
    assert {"fits", "jobs", "evolutions", "diagnoses", "annotations"} <= left_of(service, made).keys()
    shown = service.get(f"{API}/fits/{made}/deletion").json()
    counts = {"diagnoses", "hybrid simulations", "controllers", "profile likelihoods", "test plans"}
    assert (shown["kept_by"], shown["made_of"]) == ([], dict.fromkeys(counts, 1))
    gone = service.delete(f"{API}/fits/{made}")
    assert (gone.status_code, gone.json()) == (200, shown)
    assert left_of(service, made) == {}
    for path in (f"{API}/fits/{made}", f"{API}/jobs/{made}", f"/fits/{made}", f"{API}/fits/{made}/figures/bode.svg"):
        assert service.get(path).status_code == 404
    assert service.delete(f"{API}/fits/{made}").status_code == 404
    assert service.get(f"{API}/matrices/{matrix}").status_code == 200
    noted = service.get(f"{API}/audit", params={"object": f"fits/{made}"}).json()["items"]
    assert noted[0]["action"] == "delete_fit"


def approved(session: Session, fit: FitRow) -> None:
    session.add(ApprovalRow(serial=fit.serial, number=fit.set.number, until="2026-01-01T00:00:00+00:00"))


def refined(session: Session, fit: FitRow) -> None:
    other = session.scalars(select(FitRow).where(FitRow.id != fit.id)).first()
    assert other is not None
    other.parent = fit.id


def rechecked(session: Session, fit: FitRow) -> None:
    session.add(RegressionRow(id="r" + fit.id, asked={}, tolerance=1.0))
    session.add(JobRow(id="j" + fit.id, kind="recheck", state="succeeded", matrix=fit.matrix, settings={}))
    session.flush()
    session.add(RecheckRow(id="j" + fit.id, regression="r" + fit.id, fit=fit.id, serial=fit.serial))


def named(session: Session, fit: FitRow) -> None:
    everything(session, fit)
    session.flush()
    session.add(
        OwnEffectRow(
            id="o" + fit.id,
            name="o" + fit.id[:8],
            definition={},
            origin="diagnosis",
            diagnosis="d" + fit.id,
            alike=[],
            version="",
        )
    )


def worked_on(session: Session, fit: FitRow) -> None:
    session.add(
        JobRow(id="j" + fit.id, kind="diagnosis", state="queued", matrix=fit.matrix, parent=fit.id, settings={})
    )


@pytest.mark.parametrize(
    ("add", "reason"),
    [
        (approved, "it was approved"),
        (refined, "another fit starts from it"),
        (rechecked, "a regression checked it"),
        (named, "an own effect names its diagnosis"),
        (worked_on, "a job works on it"),
    ],
)
def test_what_something_else_uses_is_refused_and_nothing_of_it_goes(service, made, fitted, add, reason):
    """With the reason on the page, too; afterwards the rows are taken back, for the tests that share the service."""
    store(service, add, made)
    before = left_of(service, made)
    refused = service.delete(f"{API}/fits/{made}")
    assert (refused.status_code, refused.json()["code"]) == (409, "still-used")
    assert reason in refused.json()["detail"]
    if add is not named:  # whose diagnosis is empty: no page shows one
        assert reason.capitalize() in service.get(f"/fits/{made}").text
    assert left_of(service, made) == before
    with service.app.state.context.sessions.begin() as session:
        for table, column in ((RecheckRow, RecheckRow.id), (OwnEffectRow, OwnEffectRow.id), (JobRow, JobRow.id)):
            for row in session.scalars(select(table).where(column.endswith(made), column != made)):
                session.delete(row)
            session.flush()
        session.get_one(FitRow, fitted).parent = None
        for other in session.scalars(select(FitRow).where(FitRow.parent == made)):
            other.parent = None
        for approval in session.scalars(select(ApprovalRow).where(ApprovalRow.until == "2026-01-01T00:00:00+00:00")):
            session.delete(approval)

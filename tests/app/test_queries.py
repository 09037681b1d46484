"""Lists cost a fixed number of queries however long they are, and what belongs to an actuator is found by index."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, cast

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import event

from app.context import Context
from app.database import connect, migrate, sessions
from app.diagnoses import service as diagnoses
from app.jobs import repository
from app.jobs import service as jobs
from app.pages import service as pages
from app.processes import Here
from app.settings import Settings
from app.storage import Storage
from app.tables import ActuatorRow, Base, FitRow, JobRow, MatrixRow, SetRow

JOBS = 260  # of the busy actuator, all later than the one of the quiet actuator
SUMMARY: dict[str, Any] = {"data_hash": "", "runs": [], "findings": [], "notices": []}


@pytest.fixture(scope="module")
def context(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Context]:
    """A database of two actuators without a service around it."""
    settings = Settings(data=tmp_path_factory.mktemp("queries"))
    migrate(settings.database)
    engine = connect(settings.database)
    made = sessions(engine)
    with made.begin() as session:
        for serial in ("BUSY", "QUIET"):
            session.add(ActuatorRow(serial=serial))
            session.flush()
            session.add(MatrixRow(id=f"m-{serial}", serial=serial, source={}, summary=SUMMARY))
        session.flush()
        for number in range(JOBS):
            state = "queued" if number == JOBS - 1 else "cancelled"
            session.add(job(f"busy-{number:03}", "m-BUSY", state, f"2026-02-01T00:{number // 60:02}:{number % 60:02}"))
        session.add(job("quiet", "m-QUIET", "succeeded", "2026-01-01T00:00:00"))
        session.add(FitRow(id="quiet", matrix="m-QUIET", serial="QUIET", model="qian2014", result={}))
        session.flush()
        session.add(SetRow(fit="quiet", serial="QUIET", model="qian2014", error_fit=0.0123))
    yield Context(settings, engine, made, Storage(settings.data / "blobs"), cast(Any, None), Here(), Here())
    engine.dispose()


def job(name: str, matrix: str, state: str, at: str) -> JobRow:
    """A job as it is recorded."""
    return JobRow(id=name, matrix=matrix, state=state, created_at=at, settings={"model": "qian2014"}, progress={})


def sent(context: Context, act: Callable[[], object]) -> list[tuple[str, Any]]:
    """The statements that `act` sends, with their parameters."""
    seen: list[tuple[str, Any]] = []

    def note(*arguments: Any) -> None:
        seen.append((arguments[2], arguments[3]))

    event.listen(context.engine, "before_cursor_execute", note)
    try:
        act()
    finally:
        event.remove(context.engine, "before_cursor_execute", note)
    return seen


@pytest.mark.parametrize("limit", [1, 200])
def test_a_page_of_jobs_is_one_query(context: Context, limit: int) -> None:
    assert len(sent(context, lambda: jobs.listed(context, None, limit))) == 1
    assert len(sent(context, lambda: jobs.get(context, "quiet"))) == 1


def test_jobs_carry_the_serial_number_of_their_actuator(context: Context) -> None:
    assert {one.serial for one in jobs.listed(context, None, 200).items} == {"BUSY"}
    assert jobs.get(context, "quiet").serial == "QUIET"


def test_pages_of_an_actuators_jobs_meet_without_overlap(context: Context) -> None:
    seen: list[str] = []
    cursor = None
    while cursor is not None or not seen:
        page = jobs.listed(context, cursor, 100, serial="BUSY")
        seen += [one.id for one in page.items]
        cursor = page.next
    assert seen == [f"busy-{number:03}" for number in reversed(range(JOBS))]


def test_an_old_fit_stays_on_the_pages_of_its_actuator_and_matrix(context: Context) -> None:
    """However many jobs of other actuators are later."""
    for shown in (pages.actuator(context, "QUIET", None), pages.matrix(context, "m-QUIET", None)):
        assert [(row.id, row.error_fit) for row in shown["fits"]] == [("quiet", 0.0123)]
        assert shown["more"] is None


def test_an_actuator_with_many_fits_shows_them_page_by_page(context: Context) -> None:
    first = pages.actuator(context, "BUSY", None)
    second = pages.actuator(context, "BUSY", first["more"])
    assert {row.id for row in first["fits"]}.isdisjoint(row.id for row in second["fits"])


def test_the_list_of_actuators_costs_the_same_for_one_and_for_many(context: Context) -> None:
    """And a job that waits is shown with its own actuator only."""
    many = sent(context, lambda: pages.actuator_list(context, "", "error", None))
    one = sent(context, lambda: pages.actuator_list(context, "QUIET", "error", None))
    assert len(many) == len(one)
    states = {row.serial: row.state for row in pages.actuator_list(context, "", "error", None)["rows"]}
    assert states == {"BUSY": "queued", "QUIET": "succeeded"}


def test_what_to_do_next_is_known_of_every_actuator_of_the_list(context: Context) -> None:
    """Also where a fit of an earlier version tells no noise floor."""
    steps = pages.actuator_list(context, "", "error", None)["next"]
    at = {serial: step.at for serial, step in steps.items()}
    assert at == {"BUSY": "/fits/busy-259", "QUIET": "/fits/quiet#fails"}
    assert "noise floor is unknown" in steps["QUIET"].words


@pytest.mark.parametrize("wanted", [{"serial": "QUIET"}, {"matrix": "m-QUIET"}])
def test_the_jobs_of_an_actuator_or_matrix_are_found_by_index(context: Context, wanted: dict[str, str]) -> None:
    (statement, parameters), *_ = sent(context, lambda: jobs.listed(context, None, 50, **wanted))
    with context.engine.connect() as connection:
        plan = [row[-1] for row in connection.exec_driver_sql(f"EXPLAIN QUERY PLAN {statement}", parameters)]
    assert any("ix_jobs_matrix" in step for step in plan), plan


def test_the_diagnosis_of_a_fit_is_found_by_index(context: Context) -> None:
    for (statement, parameters), index in zip(
        sent(context, lambda: diagnoses.of_fit(context, "quiet")), ("ix_diagnoses_fit", "ix_jobs_parent"), strict=True
    ):
        with context.engine.connect() as connection:
            plan = [row[-1] for row in connection.exec_driver_sql(f"EXPLAIN QUERY PLAN {statement}", parameters)]
        assert any(index in step for step in plan), plan


def test_the_ended_jobs_that_tell_of_one_that_runs_are_found_by_index(context: Context) -> None:
    with context.sessions() as session:
        row = JobRow(id="now", kind="fit", state="running", settings={}, progress={})
        (statement, parameters), *_ = sent(context, lambda: list(repository.like(session, row, 50)))
        plan = [row[-1] for row in session.connection().exec_driver_sql(f"EXPLAIN QUERY PLAN {statement}", parameters)]
    assert any("ix_jobs_kind_ended" in step for step in plan), plan
    assert not any("TEMP B-TREE" in step for step in plan), plan


def test_the_migrations_make_the_tables_that_the_program_uses(context: Context) -> None:
    with context.engine.connect() as connection:
        assert compare_metadata(MigrationContext.configure(connection), Base.metadata) == []

"""Parameter sets say their error as the fit does: with the mean where it counts, and on which run it is unstable."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest
from alembic import command
from alembic.config import Config
from fastapi.testclient import TestClient

from app.cli.query import show
from app.database import MIGRATIONS, connect, sessions
from app.fits.repository import add_fit
from app.tables import ActuatorRow, ApprovalRow, FitRow, JobRow, MatrixRow, SetRow
from ident.fit.result import FitResult
from ident.run import USES
from ident.words.error import ErrorOf
from tests.conftest import ROOT
from tests.running_postgresql import MISSING, SERVERS, postgresql

API = "/api/v1"
SUMMARY: dict[str, Any] = {"data_hash": "", "runs": [], "findings": [], "notices": []}
STORED = json.loads((ROOT / "tests" / "stored" / "fit.json").read_text(encoding="utf-8")) | {"evolution": []}
COLUMNS = ("error_with_mean_fit", "error_with_mean_verify", "unstable_fit", "unstable_verify")
LARGE = re.compile(r"(?<![\d.])\d{4,}(\.\d*)?\s*%|e\+\d+\s*%")


def result(error: float, with_mean: float | None, *unstable: str, left_out: str = "") -> dict[str, Any]:
    """The result of a fit with these errors on both uses, unstable on the verify runs that are named."""
    runs = [
        {"id": "k1", "use": "fit", "error": error, "offset": 0.0},
        *({"id": name, "use": "verify", "error": 1e3, "offset": 0.0} for name in unstable or ("v1",)),
    ]
    lost = {"verify": 1e3} if unstable else {}
    known = {} if with_mean is None else {"error_with_mean": {"fit": with_mean, "verify": with_mean} | lost}
    out = {"left_out": [left_out]} if left_out else {}
    runs = runs if unstable else [{**run, "error": error} for run in runs]
    return {**STORED, "error": {"fit": error, "held_out": None, "verify": error} | lost, "runs": runs} | known | out


CASES = {
    "ERR-OFFSET": result(0.0282, 45.0),
    "ERR-LOST": result(0.02, 0.02, "k24"),
    "ERR-SOUND": result(0.02, 0.021),
    "ERR-EARLIER": result(0.02, None) | {"anchored_error": {"fit": 0.9, "verify": 0.9}},
    "ERR-LEFT-OUT": result(0.02, 0.02, "k24", left_out="k24") | {"error": {"fit": 0.02, "verify": None}},
}
"""Results by the serial number of their actuators: a large offset, an unstable run, and those that earlier versions
wrote, without the mean or with its earlier name."""
SAID = {
    "ERR-OFFSET": ("2.82 % (with the mean 45.0 times)", "2.82 % (with the mean 45.0 times)"),
    "ERR-LOST": ("2.00 %", "unstable on run k24"),
    "ERR-SOUND": ("2.00 %", "2.00 %"),
    "ERR-EARLIER": ("2.00 % (with the mean 90.0 %)", "2.00 % (with the mean 90.0 %)"),
    "ERR-LEFT-OUT": ("2.00 %", "–"),
}


@pytest.fixture(scope="module")
def line(service: TestClient) -> TestClient:
    """The service with an actuator a case, whose fit a job made; each is in force."""
    with service.app.state.context.sessions.begin() as session:  # type: ignore[attr-defined]
        for serial, found in CASES.items():
            session.add(ActuatorRow(serial=serial, batch="ERRORS"))
            session.flush()
            session.add(MatrixRow(id=f"m-{serial}", serial=serial, batch="ERRORS", source={}, summary=SUMMARY))
            session.flush()
            job = JobRow(
                id=f"f-{serial}", matrix=f"m-{serial}", state="succeeded", settings={"model": "qian2014"}, progress={}
            )
            session.add(job)
            session.flush()
            row = add_fit(session, job, found)
            session.add(ApprovalRow(serial=serial, number=row.set.number, who="lab"))
    return service


def items(line: TestClient) -> list[dict[str, Any]]:
    """The sets as they are sent."""
    found: list[dict[str, Any]] = line.get(f"{API}/parameter-sets", params={"batch": "ERRORS"}).json()["items"]
    return found


def test_each_set_is_sent_with_what_its_fit_says_of_its_errors(line: TestClient) -> None:
    """The error with the mean, None where earlier versions did not write it, and the unstable runs; both ways out."""
    for one in items(line):
        fit = FitResult.from_json(CASES[one["serial"]])
        for use in USES:
            said = fit.error_of(use)
            assert one[f"error_with_mean_{use}"] == said.with_mean
            assert one[f"unstable_{use}"] == list(said.unstable)
    for one in [line.get(f"{API}/actuators/{serial}").json() for serial in CASES]:
        for each in (one["current"], *one["sets"]):
            assert each["unstable_verify"] == list(
                FitResult.from_json(CASES[one["serial"]]).error_of("verify").unstable
            )
    assert len(items(line)) == len(CASES)


def test_the_exports_have_them_as_columns(line: TestClient) -> None:
    asked = {"batch": "ERRORS"}
    text = line.get(f"{API}/parameter-sets", params=asked | {"format": "csv"}).text
    rows = {row["serial"]: row for row in csv.DictReader(io.StringIO(text))}
    parquet = pq.read_table(
        io.BytesIO(line.get(f"{API}/parameter-sets", params=asked | {"format": "parquet"}).content)
    ).to_pylist()
    for one in items(line):
        (table,) = [row for row in parquet if row["serial"] == one["serial"]]
        for name in COLUMNS:
            value = ", ".join(one[name]) if name.startswith("unstable") else one[name]
            assert table[name] == value
            assert rows[one["serial"]][name] == ("" if value is None else str(value))
    assert rows["ERR-LOST"]["unstable_verify"] == "k24"


def test_the_table_of_a_terminal_says_both_errors_or_the_unstable_run(
    line: TestClient, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A row a set; what an earlier server sends has the error alone, and is shown still."""
    monkeypatch.setenv("COLUMNS", "400")
    sent = items(line)
    show(sent)
    out = capsys.readouterr().out
    for serial, said in SAID.items():
        (row,) = [line for line in out.splitlines() if serial in line]
        for text in said:
            assert text in row
    assert not LARGE.search(out)
    show([{name: value for name, value in one.items() if name not in COLUMNS} for one in sent])
    assert "2.82 %" in capsys.readouterr().out


def test_pages_say_both_errors_or_the_unstable_run(line: TestClient) -> None:
    """The list of actuators, the page of each with its fits, its next step, and its verdict against a limit."""
    listed = line.get("/", params={"q": "ERR-"}).text
    limits = {"error.verify": {"lower": None, "upper": 0.05, "unit": "1"}}
    assert line.put(f"{API}/limits/qian2014", json={"batch": "ERRORS", "limits": limits}).status_code == 200
    for serial, said in SAID.items():
        page = line.get(f"/actuators/{serial}").text
        for text in said:
            assert text in page, (serial, text)
            assert text in listed, (serial, text)
    verdict = line.get(f"{API}/actuators/ERR-LOST/verdict").json()
    assert verdict["reasons"] == ["error.verify unstable on run k24 is outside the upper limit 5.00 %"]


def test_statistics_of_an_error_count_unstable_sets_beside_the_numbers(line: TestClient) -> None:
    """An error of a thousand and more is no number to average; it lies outside an upper limit all the same."""
    limits = {"error.verify": {"lower": None, "upper": 0.05, "unit": "1"}}
    assert line.put(f"{API}/limits/qian2014", json={"batch": "ERRORS", "limits": limits}).status_code == 200
    asked = {"batch": "ERRORS", "parameter": "error.verify"}
    found = line.get(f"{API}/statistics", params=asked).json()
    assert (found["n"], found["unstable"], found["maximum"]) == (3, 1, 0.0282)
    assert found["limits"]["outside"] == 1
    assert "1 set, in no number here" in line.get("/statistics", params=asked).text
    alone = line.get(f"{API}/statistics", params={"serial": "ERR-LOST", "parameter": "error.verify"})
    assert (alone.status_code, alone.json()["code"]) == (409, "too-few")


@pytest.fixture(params=["sqlite", "postgresql"])
def database(request: pytest.FixtureRequest, tmp_path: Path, full: bool) -> Iterator[str]:
    """The URL of an empty database of either kind."""
    if request.param == "sqlite":
        yield f"sqlite:///{tmp_path / 'records.sqlite'}"
        return
    if not full:
        pytest.skip("PostgreSQL with --full")
    if not SERVERS:
        pytest.skip(MISSING)
    with postgresql() as server:
        yield server.url


def test_sets_of_earlier_versions_get_them_from_their_results(database: str) -> None:
    """The migration fills what the program writes today, of every kind of result; going back leaves the rest."""
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS))
    config.attributes["url"] = database
    engine = connect(database)
    command.upgrade(config, "head")
    with sessions(engine).begin() as session:
        for serial, found in CASES.items():
            session.add(ActuatorRow(serial=serial))
            session.flush()
            session.add(MatrixRow(id=f"m-{serial}", serial=serial, source={}, summary=SUMMARY))
            session.flush()
            row = FitRow(id=f"f-{serial}", matrix=f"m-{serial}", serial=serial, model="qian2014", result=found)
            row.set = SetRow(serial=serial, model="qian2014")
            session.add(row)
    command.downgrade(config, "0014")
    command.upgrade(config, "head")
    with sessions(engine)() as session:
        for serial, found in CASES.items():
            row = session.get_one(FitRow, f"f-{serial}").set
            fit = FitResult.from_json(found)
            for use in USES:
                said: ErrorOf = fit.error_of(use)
                stored = getattr(row, f"error_with_mean_{use}"), getattr(row, f"unstable_{use}")
                assert stored == (said.with_mean, list(said.unstable)), (serial, use)
    engine.dispose()

"""The production line's questions: who approved what, limits and verdicts, statistics, regressions, exports."""

from __future__ import annotations

import io
from typing import Any
from xml.etree import ElementTree

import pyarrow.parquet as pq
import pytest
from fastapi.testclient import TestClient
from sqlalchemy import text
from sqlalchemy.exc import IntegrityError

from app.cli.statistics import show
from app.limits.verdict import Judged, verdict
from app.tables import ActuatorRow, ApprovalRow, FitRow, MatrixRow, SetRow, ValueRow

API = "/api/v1"
SUMMARY: dict[str, Any] = {"data_hash": "", "runs": [], "findings": [], "notices": []}
VALUES = (2.60, 2.62, 2.58, 2.61, 2.59, 2.60, 2.63, 2.57, 2.60, 3.40)
"""Z0 of the sets in force in batch LINE, 1e-6 m^4/s: the last is far from the others."""


@pytest.fixture(scope="module")
def line(service: TestClient) -> TestClient:
    """The service with ten actuators of a batch, a set each in force, and one without."""
    with service.app.state.context.sessions.begin() as session:
        for number, value in enumerate(VALUES):
            serial = f"LINE-{number}"
            session.add(ActuatorRow(serial=serial, batch="LINE"))
            session.flush()
            session.add(MatrixRow(id=f"m-{serial}", serial=serial, batch="LINE", source={}, summary=SUMMARY))
            session.flush()
            row = FitRow(id=f"f-{serial}", matrix=f"m-{serial}", serial=serial, model="qian2014", result={})
            row.set = SetRow(serial=serial, batch="LINE", model="qian2014", error_fit=0.01, error_verify=0.02)
            z0 = ValueRow(name="Z0", place=0, value=1e-6 * value, unit="m^4/s", std_error=1e-8)
            row.set.values = [z0, ValueRow(name="tau", place=1, value=2.6e-3, unit="s", std_error=None)]
            session.add(row)
            session.flush()
            session.add(ApprovalRow(serial=serial, number=row.set.number, who="lab"))
        session.add(ActuatorRow(serial="LINE-BARE", batch="LINE"))
    return service


def test_every_approval_is_kept_with_who_when_and_why(service: TestClient, fitted: str, matrix: str) -> None:
    """A, then B, then A, then none: four rows that meet end to end; A is in force twice, each with its own date."""
    other = service.post(f"{API}/fits", json={"matrix": matrix, "seed": 5, "set": {"m0": 4.25}}).json()["id"]
    assert '"state":"succeeded"' in service.get(f"{API}/jobs/{other}/events").text
    if there := service.get(f"{API}/actuators/SW-1").json()["current"]:  # another test's
        service.post(f"{API}/fits/{there['id']}/withdraw")
    before = len(service.get(f"{API}/actuators/SW-1").json()["approvals"])
    for fit, why in ((fitted, "first"), (other, "better"), (fitted, "no, it was not")):
        assert service.post(f"{API}/fits/{fit}/approve", json={"why": why}).json()["current"]
    assert service.post(f"{API}/fits/{other}/withdraw").json()["code"] == "not-in-force"
    assert not service.post(f"{API}/fits/{fitted}/withdraw", json={"why": "leaks"}).json()["current"]
    actuator = service.get(f"{API}/actuators/SW-1").json()
    assert actuator["current"] is None
    rows = actuator["approvals"][: len(actuator["approvals"]) - before][::-1]
    assert [(row["fit"], row["why"]) for row in rows[-4:]] == [
        (fitted, "first"),
        (other, "better"),
        (fitted, "no, it was not"),
        (None, "leaks"),
    ]
    assert [row["to"] for row in rows[-4:-1]] == [row["from"] for row in rows[-3:]]
    assert rows[-1]["to"] is None
    assert {row["who"] for row in rows[-4:]} == {"start token"}
    assert service.get(f"{API}/fits/{fitted}").json()["approved_at"] == rows[-2]["from"]


def test_the_database_itself_holds_to_one_set_in_force(line: TestClient) -> None:
    """A second open approval of a serial number is refused by its constraint, whoever writes it."""
    with line.app.state.context.sessions() as session:
        number = session.execute(text("SELECT number FROM parameter_sets WHERE serial = 'LINE-0'")).scalar_one()
        session.add(ApprovalRow(serial="LINE-0", number=number))
        with pytest.raises(IntegrityError):
            session.flush()


def test_a_set_knows_where_it_comes_from(service: TestClient, fitted: str) -> None:
    """Data, effects, seed, program, equations, and who asked for it."""
    found = service.get(f"{API}/parameter-sets", params={"serial": "SW-1"}).json()["items"]
    lineage = next(one["lineage"] for one in found if one["id"] == fitted)
    result = service.get(f"{API}/fits/{fitted}").json()["result"]
    for name in ("data_hash", "effects", "seed", "version"):
        assert lineage[name] == result[name]
    assert len(lineage["equations"]) == 64
    assert lineage["who"] == "start token"


def test_a_batch_belongs_to_the_upload_and_not_to_the_last_one(line: TestClient) -> None:
    """When an actuator is uploaded again in another batch, its earlier sets stay in theirs."""
    with line.app.state.context.sessions.begin() as session:
        session.get_one(ActuatorRow, "LINE-1").batch = "OTHER"
    items = line.get(f"{API}/parameter-sets", params={"serial": "LINE-1"}).json()["items"]
    assert [one["batch"] for one in items] == ["LINE"]
    assert line.get(f"{API}/matrices/m-LINE-1").json()["batch"] == "LINE"


def test_statistics_of_a_batch_and_its_chart(line: TestClient) -> None:
    """The last actuator is an outlier and beyond the control limits; Cpk is there once limits are set."""
    asked = {"batch": "LINE", "parameter": "Z0"}
    found = line.get(f"{API}/statistics", params=asked).json()
    assert (found["n"], found["unit"], found["model"]) == (10, "m^4/s", "qian2014")
    assert found["mean"] == pytest.approx(1e-6 * sum(VALUES) / 10)
    assert [one["serial"] for one in found["outliers"]] == ["LINE-9"]
    assert (9, 1) in {(signal["place"], signal["rule"]) for signal in found["control_chart"]["signals"]}
    assert (found["capability"], found["no_capability"]) == (None, "no limits are set")
    body = {"batch": "LINE", "limits": {"Z0": {"lower": 2.4e-6, "upper": 2.8e-6, "unit": "m^4/s"}}}
    assert line.put(f"{API}/limits/qian2014", json=body).status_code == 200
    judged = line.get(f"{API}/statistics", params=asked).json()
    able = judged["capability"]
    assert judged["limits"] == {"lower": 2.4e-6, "upper": 2.8e-6, "outside": 1}
    assert judged["no_capability"] == ""
    assert able["outside"] == 1
    assert able["low"] < able["cpk"] < able["high"]
    for kind, magic in (("svg", b"<svg"), ("png", b"\x89PNG"), ("pdf", b"%PDF"), ("json", b"{")):
        drawn = line.get(f"{API}/statistics/figures/control-chart.{kind}", params=asked)
        assert drawn.content.startswith(magic), drawn.text[:200]
        if kind == "svg":  # ten values and nine ranges, and what is out of control once more
            assert drawn.text.count('aria-roledescription="circle"') == 19
            assert 'aria-roledescription="point"' in drawn.text
    assert line.get(f"{API}/statistics", params={"parameter": "nothing"}).json()["code"] == "no-sets"
    none = line.get("/statistics", params={"parameter": "Z0", "serial": "LINE-BARE"}).text
    assert "no approved set of LINE-BARE has &#39;Z0&#39;: approve a fit, or name another parameter" in none
    errors = {"batch": "LINE", "parameter": "error.fit"}
    assert line.get(f"{API}/statistics", params=errors).json()["mean"] == pytest.approx(0.01)
    assert "<dt>Mean</dt><dd>1.000 %</dd>" in line.get("/statistics", params=errors).text
    drawn = line.get(f"{API}/statistics/figures/control-chart.json", params=errors).text
    assert "error.fit (%)" in drawn


def test_cpk_of_too_few_sets_is_not_given_over_http_on_the_page_or_the_terminal(
    line: TestClient, capsys: pytest.CaptureFixture[str]
) -> None:
    """One set against limits: the limits and what lies outside stand, Cpk does not, and each says why."""
    body = {"batch": "LINE", "limits": {"Z0": {"lower": 2.4e-6, "upper": 2.8e-6, "unit": "m^4/s"}}}
    assert line.put(f"{API}/limits/qian2014", json=body).status_code == 200
    asked = {"parameter": "Z0", "batch": "LINE", "serial": "LINE-9"}
    found = line.get(f"{API}/statistics", params=asked).json()
    assert (found["n"], found["capability"], found["limits"]["outside"]) == (1, None, 1)
    why = "1 set; given from 10 on"
    assert found["no_capability"] == why
    show(found)
    for shown in (line.get("/statistics", params=asked).text, capsys.readouterr().out):
        assert f"not given: {why}" in " ".join(shown.split())


def test_limits_are_kept_with_their_units(line: TestClient) -> None:
    """Those of a batch come before those of all; what is no limit is refused with its place."""
    every = {"limits": {"tau": {"upper": 3, "unit": "ms"}, "error.verify": {"upper": 5, "unit": "%"}}}
    assert line.put(f"{API}/limits/qian2014", json=every).status_code == 200
    found = {each["batch"]: each["limits"] for each in line.get(f"{API}/limits/qian2014").json()["batches"]}
    assert found[""]["tau"] | {"changed_at": ""} == {
        "lower": None,
        "upper": 3.0,
        "unit": "ms",
        "si_lower": None,
        "si_upper": 0.003,
        "si_unit": "s",
        "who": "start token",
        "changed_at": "",
    }
    assert found[""]["error.verify"]["si_upper"] == pytest.approx(0.05)
    for wrong in (
        {"tau": {"upper": 3, "unit": "kg"}},
        {"nothing": {"upper": 3, "unit": "s"}},
        {"tau": {"unit": "s"}},
        {"tau": {"lower": 3, "upper": 2, "unit": "s"}},
        {"tau": {"upper": 3}},
    ):
        assert line.put(f"{API}/limits/qian2014", json={"limits": wrong}).status_code == 422
    assert line.put(f"{API}/limits/nothing", json={"limits": {}}).status_code == 422


def test_a_verdict_is_pass_fail_or_unknown_with_reasons(line: TestClient) -> None:
    """Of one within its limits, one outside, one that was not judged, and of one with nothing in force."""
    limits = {"Z0": {"lower": 2.4e-6, "upper": 2.8e-6, "unit": "m^4/s"}, "error.verify": {"upper": 5, "unit": "%"}}
    line.put(f"{API}/limits/qian2014", json={"limits": limits})
    line.put(f"{API}/limits/qian2014", json={"batch": "LINE", "limits": {}})

    def judged(serial: str) -> tuple[str, str]:
        answer = line.get(f"{API}/actuators/{serial}/verdict").json()
        return answer["verdict"], " ".join(answer["reasons"])

    assert judged("LINE-0")[0] == "pass"
    verdict_, why = judged("LINE-9")
    assert verdict_ == "fail"
    assert why.startswith("Z0 (3.400 ± 0.010)")
    assert "outside 2.4" in why
    own = {"batch": "LINE", "limits": {"Z0": {"upper": 2.61e-6, "unit": "m^4/s"}}}
    line.put(f"{API}/limits/qian2014", json=own)
    verdict_, why = judged("LINE-0")
    assert verdict_ == "unknown"
    assert "uncertain" in why
    line.put(f"{API}/limits/qian2014", json={"limits": {"tau": {"upper": 3, "unit": "ms"}}, "batch": "LINE"})
    assert "not judged" in judged("LINE-0")[1]
    assert "no parameter set is approved" in judged("LINE-BARE")[1]
    assert line.get(f"{API}/actuators/nobody/verdict").status_code == 404


@pytest.mark.parametrize(
    ("value", "error", "outcome", "uncertain"),
    [
        (5.0, 0.1, "inside", False),
        (9.81, 0.1, "unknown", True),
        (10.19, 0.1, "unknown", True),
        (10.21, 0.1, "outside", False),
        (9.79, 0.1, "inside", False),
        (5.0, None, "unknown", False),
    ],
)
def test_two_standard_errors_from_a_limit_a_value_is_uncertain(
    value: float, error: float | None, outcome: str, uncertain: bool
) -> None:
    """On either side of it; beyond, it is judged. A value without a standard error is not."""
    one = Judged("Z0", value, error, "1", 0.0, 10.0)
    assert (one.outcome, one.uncertain) == (outcome, uncertain)
    certain = Judged("tau", 20.0, 0.1, "1", 0.0, 10.0)
    assert verdict([one, certain]) == "fail"
    assert verdict([one]) == {"inside": "pass", "outside": "fail", "unknown": "unknown"}[outcome]


def test_an_export_is_complete_and_streamed(line: TestClient) -> None:
    """Both kinds have every set of the query, a column a parameter in the model's order."""
    asked = {"batch": "LINE"}
    rows = line.get(f"{API}/parameter-sets", params=asked | {"format": "csv"}).text.splitlines()
    assert len(rows) == 1 + len(VALUES)
    assert rows[0].endswith("Z0 (m^4/s),std_error Z0 (m^4/s),tau (s),std_error tau (s)")
    table = pq.read_table(io.BytesIO(line.get(f"{API}/parameter-sets", params=asked | {"format": "parquet"}).content))
    assert table.column("Z0 (m^4/s)").to_pylist() == [1e-6 * value for value in reversed(VALUES)]
    assert table.column("current").to_pylist() == [True] * len(VALUES)


def test_a_regression_rechecks_what_is_in_force(service: TestClient, fitted: str) -> None:
    """A job an actuator; unchanged, nothing moved. What was stored otherwise has moved, and JUnit says so."""
    service.post(f"{API}/fits/{fitted}/approve")
    asked = {"serial": "SW-1"}
    assert outcome(service, asked)["state"] == "passed"
    with service.app.state.context.sessions.begin() as session:
        row = session.get_one(FitRow, fitted)
        changed = {**row.result["parameters"]["Z0"], "value": 1.01 * row.result["parameters"]["Z0"]["value"]}
        sound = row.result
        row.result = {**sound, "parameters": {**sound["parameters"], "Z0": changed}}
    found = outcome(service, asked)
    with service.app.state.context.sessions.begin() as session:
        session.get_one(FitRow, fitted).result = sound
    assert found["state"] == "failed"
    assert "Z0" in {change["quantity"] for change in found["rechecks"][0]["moved"]}
    junit = service.get(f"{API}/regressions/{found['id']}", params={"format": "junit"})
    assert ElementTree.fromstring(junit.content).get("failures") == "1"
    assert service.get(f"{API}/regressions").json()["items"][0]["id"] == found["id"]


def outcome(service: TestClient, asked: dict[str, str]) -> dict[str, Any]:
    """A regression when it has ended."""
    started = service.post(f"{API}/regressions", json=asked)
    assert started.status_code == 202, started.text
    for recheck in started.json()["rechecks"]:
        service.get(f"{API}/jobs/{recheck['job']}/events")
    found: dict[str, Any] = service.get(started.headers["Location"]).json()
    return found


@pytest.mark.parametrize(
    "path",
    [
        "/statistics?parameter=Z0&batch=LINE",
        "/limits?model=qian2014&batch=LINE",
        "/regressions",
        "/actuators/SW-1",
        "/statistics?parameter=nothing",
    ],
)
@pytest.mark.usefixtures("fitted")
def test_the_pages_of_the_line_are_shown(line: TestClient, path: str) -> None:
    page = line.get(path)
    assert page.status_code == 200, page.text[:500]
    assert "Production line" in page.text or "<h2>Verdict</h2>" in page.text

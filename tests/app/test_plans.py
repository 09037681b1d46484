"""Test plans over HTTP and on their page: made once, kept, sent as an archive that is read as a matrix."""

from __future__ import annotations

import io
import zipfile

import pytest
import yaml

API = "/api/v1"
PROGRAM = {"gains": [5], "amplitudes": ["0.02 in", "0.1 in"], "seconds": "0.5 s"}
RIG = {"stroke": "152.4 mm", "speed": "0.2 m/s"}


def test_a_plan_is_made_of_a_fit_and_sent_as_files(service, fitted):
    """The peaks are those of the fitted model; the archive has a command and an entry a run."""
    asked = {"program": PROGRAM, "fit": fitted, "rig": RIG}
    made = service.post(f"{API}/plans", json=asked, headers={"Idempotency-Key": "plan-1"})
    assert made.status_code == 201, made.text
    again = service.post(f"{API}/plans", json=asked, headers={"Idempotency-Key": "plan-1"})
    assert again.json() == made.json()
    plan = made.json()
    assert service.get(made.headers["Location"]).json() == plan
    assert [run["limit"] for run in plan["runs"]] == ["speed", "speed"]
    assert plan["runs"][1]["scale"] < 1 == plan["runs"][0]["scale"]
    assert service.get(f"{API}/plans", params={"fit": fitted}).json()["items"] == [plan]
    sent = service.get(f"{API}/plans/{plan['id']}.zip")
    files = zipfile.ZipFile(io.BytesIO(sent.content))
    described = yaml.safe_load(files.read("matrix.yaml"))
    assert {f"commands/{run['id']}.csv" for run in described["runs"]} < set(files.namelist())
    assert described["actuator"]["serial"] == "SW-1"
    page = service.get("/plan", params={"plan": plan["id"]}).text
    assert "2 runs of own" in page
    assert f"/api/v1/plans/{plan['id']}.zip?format=tdms" in page


@pytest.mark.parametrize(
    ("change", "status", "code"),
    [
        ({"program": "/etc/passwd"}, 422, "no-such-program"),
        ({"fit": "none"}, 404, "no-such-fit"),
        ({"rig": {"speed": "3"}}, 422, "missing-unit"),
        ({"least": 1.0, "rig": {"speed": "1 mm/s"}}, 422, "beyond-limits"),
        ({"spread": "120 %"}, 422, "bad-value"),
        ({"spread": "3", "sped": 1}, 422, "invalid-request"),
    ],
)
def test_what_cannot_be_planned_is_a_problem(service, change, status, code):
    answer = service.post(f"{API}/plans", json={"program": PROGRAM, **change})
    assert (answer.status_code, answer.json()["code"]) == (status, code), answer.text


def test_a_plan_or_a_format_that_is_not_there_is_not_found(service):
    assert service.get(f"{API}/plans/none").status_code == 404
    assert service.get(f"{API}/plans/none.zip").status_code == 404
    assert service.get("/plan", params={"plan": "none"}).status_code == 404

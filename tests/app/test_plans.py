"""Test plans over HTTP and on their page: queued once, made by a job, sent as an archive that is read as a matrix."""

from __future__ import annotations

import io
import time
import zipfile
from threading import Event

import pytest
import yaml

from app.plans import service as plans
from app.plans.request_parsing import AskedPlan
from ident.progress import Progress

API = "/api/v1"
PROGRAM = {"gains": [5], "amplitudes": ["0.02 in", "0.1 in"], "seconds": "0.5 s"}
RIG = {"stroke": "152.4 mm", "speed": "0.2 m/s"}


def ended(service, job):
    """A job when it has ended."""
    service.get(f"{API}/jobs/{job}/events")
    return service.get(f"{API}/jobs/{job}").json()


def made(service, asked, **headers):
    """The plan that a queued job has made."""
    queued = service.post(f"{API}/plans", json=asked, headers=headers)
    assert queued.status_code == 202, queued.text
    job = ended(service, queued.json()["id"])
    assert (job["state"], job["kind"], job["plan"]) == ("succeeded", "plan", job["id"]), job
    return service.get(f"{API}/plans/{job['plan']}").json()


def test_a_plan_is_made_of_a_fit_and_sent_as_files(service, fitted):
    """The peaks are those of the fitted model; the archive has a command and an entry a run."""
    asked = {"program": PROGRAM, "fit": fitted, "rig": RIG}
    plan = made(service, asked, **{"Idempotency-Key": "plan-1"})
    assert made(service, asked, **{"Idempotency-Key": "plan-1"}) == plan
    job = service.get(f"{API}/jobs/{plan['id']}").json()
    assert (job["serial"], job["parent"], job["settings"]["program"]) == ("SW-1", fitted, "own")
    assert (job["progress"]["done"], job["progress"]["total"]) == (2, 2)
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


def test_a_plan_without_a_fit_is_about_no_actuator(service):
    """It needs no runs: its job stands in the list of jobs, with the plan's page; it is no job that makes a fit."""
    plan = made(service, {"program": PROGRAM})
    job = service.get(f"{API}/jobs").json()["items"][0]
    assert (job["id"], job["matrix"], job["serial"], job["parent"]) == (plan["id"], "", "", None)
    assert f"/plan?plan={plan['id']}#made" in service.get("/jobs").text
    assert plan["fit"] is None
    assert service.get(f"/fits/{plan['id']}", follow_redirects=False).headers["Location"].startswith("/plan?")


def test_a_plan_that_is_made_between_two_looks_of_its_page_is_shown(service, monkeypatch):
    plan = made(service, {"program": PROGRAM})
    monkeypatch.setattr(plans, "made_as", lambda *_: None)
    assert "2 runs of own" in service.get("/plan", params={"plan": plan["id"]}).text


def test_a_plan_of_which_no_run_is_left_fails_and_its_page_says_why(service, fitted):
    asked = {"program": PROGRAM, "fit": fitted, "least": 1.0, "rig": {"speed": "1 mm/s"}}
    job = ended(service, service.post(f"{API}/plans", json=asked).json()["id"])
    assert (job["state"], job["problem"]["code"], job["plan"]) == ("failed", "beyond-limits", None)
    page = service.get("/plan", params={"plan": job["id"]}).text
    assert "The plan failed." in page
    assert "shrink its amplitude" in page.lower()
    assert service.get(f"{API}/plans/{job['id']}").json()["code"] == "no-such-plan"


def test_a_plan_is_cancelled_at_its_next_run(service, fitted, monkeypatch):
    """Reported run by run: the job stops after the run that is under way, and keeps nothing."""
    begun = Event()

    def slow(_asked, _fit, report):
        begun.set()
        for done in range(1000):
            time.sleep(0.25)  # longer than what a report may be held back
            report(Progress("plan", done, 1000))

    monkeypatch.setattr(AskedPlan, "made", slow)
    job = service.post(f"{API}/plans", json={"program": PROGRAM, "fit": fitted}).json()["id"]
    assert begun.wait(30)
    assert "Progress of the plan" in service.get("/plan", params={"plan": job}).text
    service.delete(f"{API}/jobs/{job}")
    assert ended(service, job)["state"] == "cancelled"
    assert "The plan was cancelled" in service.get("/plan", params={"plan": job}).text


@pytest.mark.parametrize(
    ("change", "status", "code"),
    [
        ({"program": "/etc/passwd"}, 422, "no-such-program"),
        ({"fit": "none"}, 404, "no-such-fit"),
        ({"rig": {"speed": "3"}}, 422, "missing-unit"),
        ({"program": {**PROGRAM, "seconds": "600 s", "gains": list(range(1, 101))}}, 422, "too-large"),
        ({"program": "kononykhin", "ramp": "1 s"}, 422, "bad-option"),
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


def test_a_job_that_makes_no_plan_has_no_page_of_one(service, fitted):
    assert service.get("/plan", params={"plan": fitted}).status_code == 404

"""What is missing, over HTTP: diagnose a fit, add what it lacks, look back on the way."""

from __future__ import annotations

import io
import json
import re
import zipfile
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient

from app.diagnoses.work import DIAGNOSIS
from app.jobs import repository
from app.jobs.steps import Runs
from app.jobs.work import InOnePiece, Kind, MadeSoFar, State, Task
from ident.diagnosis.result import Diagnosis
from ident.progress import Progress
from ident.readers import read_matrix
from ident.workflows import identify
from tests.app.conftest import reached
from tests.conftest import of_few_effects
from tests.hidden_dead_zone import HALF_WIDTH, write, zipped

API = "/api/v1"
OWN = {
    "name": "overlap",
    "place": "spool",
    "equation": "w = w - clip(w, -h, h)",
    "meaning": "the lands overlap",
    "strength": {"symbol": "h", "unit": "mm", "lower": 0, "upper": 1},
}


def ended(service: TestClient, answer: Any) -> dict[str, Any]:
    """The job of a 202, when it has ended."""
    assert answer.status_code == 202, answer.text
    assert answer.headers["Location"] == f"{API}/jobs/{answer.json()['id']}"
    service.get(f"{answer.headers['Location']}/events")
    job: dict[str, Any] = service.get(answer.headers["Location"]).json()
    return job


@pytest.fixture(scope="module")
def matrix(service: TestClient) -> str:
    """A matrix of a machine with a dead zone."""
    return str(service.post(f"{API}/matrices", files={"files": ("m.zip", zipped())}).json()["id"])


@pytest.fixture(scope="module")
def linear(service: TestClient, matrix: str) -> str:
    """A fit of it that lacks the dead zone."""
    job = ended(service, service.post(f"{API}/fits", json={"matrix": matrix}))
    assert job["state"] == "succeeded", job
    return str(job["fit"])


@pytest.fixture(scope="module")
def diagnosis(service: TestClient, linear: str, full: bool) -> dict[str, Any]:
    """Its diagnosis; the whole catalogue is ranked in tests/diagnosis/test_diagnose.py."""
    with of_few_effects(full):
        job = ended(service, service.post(f"{API}/diagnoses", json={"fit": linear, "max_effects": 2, "seed": 5}))
    assert (job["kind"], job["state"], job["fit"], job["parent"]) == ("diagnosis", "succeeded", None, linear), job
    found: dict[str, Any] = service.get(f"{API}/diagnoses/{job['diagnosis']}").json()
    seen = job["progress"]["expected"]  # at first sight, while the rest was under way
    assert seen[0] == {"effect": "dead_zone", "error": found["candidates"][0]["predicted_error"]}
    assert [one["error"] for one in seen] == sorted(one["error"] for one in seen)
    assert [one["effect"] for one in job["progress"]["added"]] == ["dead_zone"]
    assert job["progress"]["added"][0]["error"] == found["ladder"][1]["error"]["held_out"]
    return found


def promised(service: TestClient, answer: Any, diagnosis: dict[str, Any]) -> dict[str, Any]:
    """The fit that a 202 leads to: it begins where the diagnosis ended, and ends at or below that."""
    job = ended(service, answer)
    assert job["state"] == "succeeded", job
    assert (job["parent"], job["settings"]["start"]["of"]) == (diagnosis["fit"], "diagnosis")
    fit: dict[str, Any] = service.get(f"{API}/fits/{job['fit']}").json()["result"]
    assert (fit["effects"], fit["method"]) == (["dead_zone"], "refinement")
    assert fit["error"]["fit"] <= (1 + 1e-6) * diagnosis["ladder"][-1]["error"]["fit"]
    return fit


def test_the_recommended_fit_is_one_and_the_same_by_every_way(service, diagnosis, linear, matrix, tmp_path):
    """`POST /fits` with a start, what the page's button sends, and the library; a fit may go on from a fit as well."""
    start = {"diagnosis": diagnosis["id"]}
    first = promised(service, service.post(f"{API}/fits", json={"matrix": matrix, "start": start}), diagnosis)
    asked = {"effects": ["dead_zone"], "diagnosis": diagnosis["id"]}
    second = promised(service, service.post(f"{API}/fits/{linear}/effects", json=asked), diagnosis)
    own = identify(read_matrix(write(tmp_path / "m")), start=Diagnosis.from_json(diagnosis))
    assert first["parameters"] == second["parameters"] == json.loads(json.dumps(own.to_json()["parameters"]))
    job = ended(service, service.post(f"{API}/fits", json={"matrix": matrix, "start": {"fit": linear}}))
    assert (job["state"], job["parent"]) == ("succeeded", linear)
    stored = [service.get(f"{API}/fits/{fit}").json()["result"]["error"]["fit"] for fit in (linear, job["fit"])]
    assert stored[1] <= (1 + 1e-6) * stored[0]
    assert service.get(f"/jobs/{job['id']}").status_code == 200


def test_every_button_of_a_diagnosis_names_it(service, diagnosis, linear):
    """So that the fit that it adds begins where the diagnosis ended."""
    page = service.get(f"/fits/{linear}").text
    section = page[
        page.index('id="missing"') : page.index("thousands of equation terms") if "Terms of the" in page else None
    ]
    forms = re.findall(r'<form[^>]*data-add="[^"]*"[^>]*>', section)
    named = [form for form in forms if f'data-diagnosis="{diagnosis["id"]}"' in form]
    assert len(named) >= len([one for one in diagnosis["candidates"] if one["parameters"]])


@pytest.mark.parametrize(
    ("start", "beside", "said"),
    [
        ({}, {}, "a start names one result: a fit or a diagnosis"),
        ({"fit": "f", "diagnosis": "d"}, {}, "give one of the two"),
        ({"diagnosis": "DIAGNOSIS"}, {"model": "strano"}, "model cannot be given with a start"),
        ({"diagnosis": "DIAGNOSIS"}, {"seed": 4}, "seed cannot be given with a start"),
        ({"diagnosis": "DIAGNOSIS", "effects": ["stiction"]}, {}, "refitted no model with just stiction"),
        ({"diagnosis": "nothing"}, {}, "no diagnosis"),
        ({"fit": "nothing"}, {}, "no fit"),
    ],
)
def test_a_start_that_cannot_be_is_refused(service, diagnosis, matrix, start, beside, said):
    start = {name: diagnosis["id"] if value == "DIAGNOSIS" else value for name, value in start.items()}
    answer = service.post(f"{API}/fits", json={"matrix": matrix, "start": start, **beside})
    assert answer.status_code in (404, 422)
    assert said in answer.text


@pytest.fixture(scope="module")
def mended(service: TestClient, linear: str) -> str:
    """The fit with the dead zone."""
    job = ended(service, service.post(f"{API}/fits/{linear}/effects", json={"effect": "dead_zone"}))
    assert (job["kind"], job["state"], job["parent"]) == ("fit", "succeeded", linear), job
    return str(job["fit"])


def test_the_diagnosis_of_a_fit_finds_what_was_hidden(diagnosis, linear, matrix):
    assert (diagnosis["fit"], diagnosis["matrix"], diagnosis["serial"]) == (linear, matrix, "DZ-1")
    assert diagnosis["verdict"]["effects"] == ["dead_zone"]
    assert diagnosis["candidates"][0]["effect"] == "dead_zone"
    assert diagnosis["ladder"][-1]["error"]["verify"] < diagnosis["baseline"]["error"]["verify"] / 2
    assert diagnosis["seed"] == 5
    promised = "baseline noise_floor budget candidates ladder verdict next_experiment seconds id created_at"
    assert set(promised.split()) <= set(diagnosis)


def test_the_diagnoses_of_a_fit_are_listed(service, diagnosis, linear):
    listed = service.get(f"{API}/diagnoses", params={"fit": linear}).json()["items"]
    assert [one["id"] for one in listed] == [diagnosis["id"]]
    assert service.get(f"{API}/diagnoses", params={"fit": "none"}).json()["items"] == []
    assert service.get(f"{API}/diagnoses/none").status_code == 404


@pytest.mark.usefixtures("few_effects")
def test_a_diagnosis_without_a_fit_makes_one_first(service, matrix):
    body = {"matrix": matrix, "seed": 2, "max_effects": 0}
    job = ended(service, service.post(f"{API}/diagnoses", json=body))
    assert job["fit"] == job["diagnosis"] == job["id"]
    assert service.get(f"{API}/fits/{job['fit']}").json()["result"]["seed"] == 2
    found = service.get(f"{API}/diagnoses/{job['id']}").json()
    assert (found["fit"], len(found["ladder"])) == (job["id"], 1)


def test_an_effect_is_added_and_the_ladder_leads_back(service, linear, mended):
    fit = service.get(f"{API}/fits/{mended}").json()
    assert fit["parent"] == linear
    assert fit["result"]["effects"] == ["dead_zone"]
    assert fit["result"]["parameters"]["dead_zone.half_width"]["value"] == pytest.approx(HALF_WIDTH, rel=0.02)
    first, second = service.get(f"{API}/fits/{mended}/ladder").json()["rungs"]
    assert (first["fit"], first["added"], second["fit"], second["added"]) == (linear, [], mended, ["dead_zone"])
    assert second["error"]["verify"] < first["error"]["verify"] / 2
    assert first["data_hash"] == second["data_hash"]
    assert {"seed", "version", "parameters"} <= set(second)


def test_the_way_is_drawn_with_its_errors_and_the_floor(service, mended):
    spec = service.get(f"{API}/fits/{mended}/figures/ladder.json").json()
    rows = spec["datasets"]["steps"]
    assert [row["step"].rpartition(". ")[2] for row in rows[2:]] == ["dead zone", "dead zone"]
    assert {row["u"] for row in rows} == {"estimation data", "validation data"}
    assert "noise floor 0." in str(spec["title"])
    for kind, start in (("svg", b"<svg"), ("png", b"\x89PNG"), ("pdf", b"%PDF")):
        assert service.get(f"{API}/fits/{mended}/figures/ladder.{kind}").content.startswith(start)
    answer = service.get(f"{API}/fits/{mended}/figures/ladder.json", params={"kp": "1"})
    assert (answer.status_code, answer.json()["code"]) == (422, "unknown-option")


def test_the_next_experiment_is_told_and_downloaded(service, diagnosis):
    """The words are those of the archive, whose command has the amplitude that they state."""
    told = service.get(f"{API}/diagnoses/{diagnosis['id']}/proposal").json()
    answer = service.get(f"{API}/diagnoses/{diagnosis['id']}/next-experiment")
    assert answer.headers["content-type"] == "application/zip"
    with zipfile.ZipFile(io.BytesIO(answer.content)) as archive:
        assert sorted(archive.namelist()) == ["command.csv", "command.mat", "experiment.json"]
        assert json.loads(archive.read("experiment.json"))["text"] == told["text"]
        rows = np.loadtxt(io.BytesIO(archive.read("command.csv")), delimiter=",", skiprows=1)
    assert len(rows) == round(told["seconds"] * told["sample_rate"])
    assert np.sqrt(np.mean(rows[:, 1] ** 2)) == pytest.approx(1e3 * told["amplitude"], rel=0.01)
    assert service.get(f"{API}/diagnoses/none/next-experiment").status_code == 404


def test_adding_is_undone_by_approving_the_fit_before(service, linear, mended):
    for fit in (mended, linear):
        approved = service.post(f"{API}/fits/{fit}/approve", json={"why": "the model before it will do"})
        assert approved.json()["current"] is True, approved.text
        found = service.get(f"{API}/parameter-sets", params={"serial": "DZ-1", "current": True}).json()["items"]
        assert [one["id"] for one in found] == [fit]


@pytest.mark.parametrize(
    ("body", "status", "code"),
    [
        ({"effect": "magic"}, 422, "unknown-effect"),
        ({"effects": ["dead_zone"]}, 409, "effect-there"),
        ({}, 422, "bad-request"),
    ],
)
def test_an_effect_that_cannot_be_added_is_refused(service, mended, body, status, code):
    answer = service.post(f"{API}/fits/{mended}/effects", json=body)
    assert (answer.status_code, answer.json()["code"]) == (status, code)
    assert answer.json()["remedy"]


@pytest.mark.parametrize(
    ("body", "status", "code"),
    [
        ({}, 422, "bad-request"),
        ({"fit": "FIT", "matrix": "x"}, 422, "bad-request"),
        ({"fit": "FIT", "model": "first_order"}, 422, "bad-request"),
        ({"fit": "FIT", "max_effects": 99}, 422, "bad-option"),
        ({"matrix": "MATRIX", "model": "magic"}, 422, "unknown-model"),
        ({"fit": "FIT", "bounds": {"tau": ["1 ms", "5 ms"]}}, 422, "bad-option"),
        ({"fit": "FIT", "bounds": {"dead_zone.width": ["1 um", "1 mm"]}}, 422, "unknown-parameter"),
        ({"matrix": "MATRIX", "bounds": {"dead_zone": ["1 mm", "1 um"]}}, 422, "empty-bounds"),
        ({"fit": "none"}, 404, "no-such-fit"),
        ({"matrix": "none"}, 404, "no-such-matrix"),
    ],
)
def test_a_diagnosis_that_cannot_be_is_refused(service, linear, matrix, body, status, code):
    named = {"FIT": linear, "MATRIX": matrix}
    asked = {key: named.get(value, value) if isinstance(value, str) else value for key, value in body.items()}
    answer = service.post(f"{API}/diagnoses", json=asked)
    assert (answer.status_code, answer.json()["code"]) == (status, code)


@pytest.mark.parametrize("of", ["fit", "matrix"])
def test_bounds_of_an_effect_that_may_be_added_are_kept_with_the_job(service, linear, matrix, of):
    """Beside a fit as with a matrix; a fit alone refuses them, for its model does not have the effect."""
    bounds = {"dead_zone.half_width": ["1 um", "0.4 mm"], "presliding_friction.displacement": [1e-6, 1e-3]}
    given = {"fit": linear, "matrix": matrix}[of]
    job = service.post(f"{API}/diagnoses", json={of: given, "bounds": bounds, "seed": 11}).json()
    service.delete(f"{API}/jobs/{job['id']}")
    assert job["settings"]["bounds"]["dead_zone.half_width"] == pytest.approx([1e-6, 4e-4])
    assert job["settings"]["bounds"]["presliding_friction.displacement"] == [1e-6, 1e-3]
    refused = service.post(f"{API}/fits", json={"matrix": matrix, "bounds": bounds})
    assert (refused.status_code, refused.json()["code"]) == (422, "unknown-parameter")


def test_a_running_diagnosis_is_cancelled_and_leaves_nothing(service, linear):
    job = service.post(f"{API}/diagnoses", json={"fit": linear, "seed": 9}).json()["id"]
    reached(service, job, '"stage":"predicting"')
    service.delete(f"{API}/jobs/{job}")
    assert '"state":"cancelled"' in service.get(f"{API}/jobs/{job}/events").text
    assert service.get(f"{API}/diagnoses/{job}").status_code == 404


def test_a_result_is_stored_once_and_one_that_cannot_be_ends_its_job(service, diagnosis, linear, matrix):
    """As after a kill between the last step and its record; nothing is left half written."""
    context = service.app.state.context
    runs = Runs(context.sessions, context.storage, "here", DIAGNOSIS)
    made = {"outcome": None, "state": {"diagnosis": {**diagnosis, "seconds": 1.0}, "fit": None}}
    runs.take(diagnosis["id"]).store(made)
    assert service.get(f"{API}/diagnoses/{diagnosis['id']}").json() == diagnosis
    with context.sessions.begin() as session:
        repository.add(session, "twice", matrix, {}, linear, "diagnosis")
        repository.add(session, "broken", matrix, {}, linear, "diagnosis")
    for _ in range(2):
        runs.take("twice").store(made)
    runs.take("broken").store({"outcome": None, "state": {"diagnosis": {"x": object()}, "fit": None}})
    listed = service.get(f"{API}/diagnoses", params={"fit": linear}).json()["items"]
    assert sorted(one["id"] for one in listed) == sorted(["twice", diagnosis["id"]])
    assert service.get(f"{API}/jobs/broken").json()["problem"]["code"] == "not-stored"


@pytest.mark.parametrize("fails", [True, False])
def test_the_catalogues_verdict_is_kept_whatever_becomes_of_the_job(service, diagnosis, linear, matrix, fails):
    """It is stored before terms are searched for, seen with the job, and gives way to the whole where that comes."""
    so_far = {**diagnosis, "complete": False, "not_looked_at": ["search for unknown terms"]}
    seen: list[dict[str, Any]] = []
    name = f"kept-{fails}"

    class Cut(InOnePiece):
        def __init__(self, task: Task) -> None:
            self.task = task

        def finish(self, state: State) -> State:  # noqa: ARG002  nothing comes before it
            self.task.report(MadeSoFar("kept", 1, 1, made={"diagnosis": so_far, "fit": None}))
            self.task.report(Progress("proposing", 3, 3, verdict=so_far["verdict"]["text"]))
            seen.append(service.get(f"{API}/jobs/{name}").json())
            seen.append(service.get(f"{API}/diagnoses/{name}").json())
            if fails:
                raise RuntimeError("somewhere inside")
            return {"diagnosis": diagnosis, "fit": None}

    context = service.app.state.context
    with context.sessions.begin() as session:
        repository.add(session, name, matrix, {}, linear, "diagnosis")
    run = Runs(context.sessions, context.storage, "here", Kind("diagnosis", Cut, DIAGNOSIS.keep)).take(name)
    run.store(run.finish(run.begin()["state"]))
    job, kept = seen
    assert (job["state"], job["diagnosis"], job["progress"]["verdict"]) == (
        "running",
        name,
        diagnosis["verdict"]["text"],
    )
    assert (kept["complete"], kept["verdict"]) == (False, diagnosis["verdict"])
    assert service.get(f"{API}/jobs/{name}").json()["state"] == ("failed" if fails else "succeeded")
    found = service.get(f"{API}/diagnoses/{name}").json()
    assert (found["complete"], found.get("not_looked_at", [])) == (
        (False, so_far["not_looked_at"]) if fails else (True, [])
    )


def test_a_diagnosis_without_the_time_for_a_fit_says_so(service, matrix):
    """There is nothing that could be kept."""
    job = ended(service, service.post(f"{API}/diagnoses", json={"matrix": matrix, "time": 0.001}))
    assert (job["state"], job["problem"]["code"], job["diagnosis"]) == ("failed", "no-time", None)
    assert job["problem"]["detail"] == "0.001 s are over before a model is fitted"


def test_a_diagnosis_is_no_fit_of_the_actuators_page(service, diagnosis, linear):
    page = service.get("/actuators/DZ-1").text
    assert f"/fits/{linear}" in page
    assert f"/fits/{diagnosis['id']}" not in page


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_an_own_effect_is_ranked_beside_the_catalogue_and_added(service, linear):
    """A dead zone under another name: the data cannot tell the two apart, and either can be added."""
    job = ended(service, service.post(f"{API}/diagnoses", json={"fit": linear, "max_effects": 1, "custom": [OWN]}))
    found = service.get(f"{API}/diagnoses/{job['diagnosis']}").json()
    own, listed = (next(c for c in found["candidates"] if c["effect"] == name) for name in ("overlap", "dead_zone"))
    assert own["error"]["held_out"] == pytest.approx(listed["error"]["held_out"], rel=0.01)
    assert found["settings"]["custom"][0]["equation"] == OWN["equation"]
    assert service.get(f"{API}/diagnoses/{job['diagnosis']}/proposal").status_code == 200
    assert "overlap" in service.get(f"/fits/{linear}").text
    added = service.post(f"{API}/fits/{linear}/effects", json={"effects": ["overlap"], "custom": [OWN]})
    fit = service.get(f"{API}/fits/{ended(service, added)['fit']}").json()["result"]
    assert fit["parameters"]["overlap.h"]["value"] == pytest.approx(HALF_WIDTH, rel=0.02)
    bad = {"fit": linear, "custom": [OWN | {"equation": "w = w +"}]}
    assert service.post(f"{API}/diagnoses", json=bad).json()["where"] == "equation, character 8"


def test_a_diagnosis_whose_time_is_over_is_what_was_found(service, linear):
    job = ended(service, service.post(f"{API}/diagnoses", json={"fit": linear, "time": 0.001}))
    assert job["settings"]["time"] == 0.001
    found = service.get(f"{API}/diagnoses/{job['diagnosis']}").json()
    assert (found["complete"], found["verdict"]["effects"], found["next_experiment"]) == (False, [], {})
    assert (found["budget"], found["candidates"]) == ({}, [])
    assert {"error budget", "next run", "search for unknown terms"} <= {*found["not_looked_at"]}
    assert service.post(f"{API}/diagnoses", json={"fit": linear, "time": 0}).status_code == 422


def test_a_running_diagnosis_is_stopped_and_keeps_what_it_found(service, linear):
    """It says that it is not complete; a fit has nothing to keep."""
    job = service.post(f"{API}/diagnoses", json={"fit": linear, "seed": 10}).json()["id"]
    reached(service, job, '"stage":"trying"')
    service.post(f"{API}/jobs/{job}/conclude")
    assert '"state":"succeeded"' in service.get(f"{API}/jobs/{job}/events").text
    found = service.get(f"{API}/diagnoses/{job}").json()
    assert not found["complete"]
    assert "The search was stopped early" in found["verdict"]["text"]
    refused = service.post(f"{API}/jobs/{linear}/conclude")
    assert (refused.status_code, refused.json()["code"]) == (409, "not-a-diagnosis")

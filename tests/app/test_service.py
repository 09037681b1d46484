"""A lab's day over HTTP: upload, fit, look, approve, query."""

from __future__ import annotations

import io
from pathlib import Path

import pyarrow.parquet as pq
import pytest
from fastapi.testclient import TestClient

from ident.synthesis.matrix import simulate_matrix
from tests.app.conftest import files, reached, zipped
from tests.short_form import short_form


def test_the_same_bytes_again_are_the_same_matrix(service: TestClient, matrix: str) -> None:
    again = service.post("/api/v1/matrices", files={"files": ("other-name.zip", zipped())})
    assert (again.status_code, again.json()["id"]) == (200, matrix)
    loose = service.post("/api/v1/matrices", files=[("files", (name, body)) for name, body in files().items()])
    assert (loose.status_code, loose.json()["id"]) == (200, matrix)


@pytest.mark.usefixtures("matrix")
def test_raw_bytes_are_kept_as_they_came(service: TestClient) -> None:
    blobs = [p.read_bytes() for p in service.app.state.context.storage.folder.rglob("*") if p.is_file()]
    assert zipped() in blobs


def test_a_fit_finds_the_reference_and_its_verify_runs_agree(service: TestClient, fitted: str) -> None:
    result = service.get(f"/api/v1/fits/{fitted}").json()["result"]
    assert result["parameters"]["Z0"]["value"] == pytest.approx(2.592e-6, rel=0.01)
    assert result["error"]["verify"] < 1.1 * result["noise_floor"]["verify"]


def test_events_resume_after_the_last_one_seen(service: TestClient, fitted: str) -> None:
    whole = service.get(f"/api/v1/jobs/{fitted}/events").text
    last = max(int(line.removeprefix("id: ")) for line in whole.splitlines() if line.startswith("id: "))
    rest = service.get(f"/api/v1/jobs/{fitted}/events", headers={"Last-Event-ID": str(last)}).text
    assert "id:" not in rest
    assert "id:" in service.get(f"/api/v1/jobs/{fitted}/events", headers={"Last-Event-ID": str(last - 1)}).text


@pytest.mark.parametrize("kind", short_form(["json", "svg", "png", "pdf"], "json", "svg"))
def test_the_bode_plot_is_served_in_every_format(service: TestClient, fitted: str, kind: str) -> None:
    answer = service.get(f"/api/v1/fits/{fitted}/figures/bode.{kind}")
    starts = {"json": b"{", "svg": b"<svg", "png": b"\x89PNG", "pdf": b"%PDF"}
    assert answer.status_code == 200
    assert answer.content.startswith(starts[kind])


def test_the_comparison_says_where_the_model_fails(service: TestClient, fitted: str) -> None:
    found = service.get(f"/api/v1/fits/{fitted}/compare").json()
    assert {curve["name"] for curve in found["curves"]} >= {"spool", "friction", "leakage"}
    assert found["budget"]["noise"] == pytest.approx(0.005, rel=0.2)
    assert len(found["bands"]["runs"]) == len(found["runs"])


@pytest.mark.parametrize("name", ["residual-map", "residual-curve"])
def test_where_the_model_fails_is_drawn(service: TestClient, fitted: str, name: str) -> None:
    assert service.get(f"/api/v1/fits/{fitted}/figures/{name}.svg").content.startswith(b"<svg")
    assert service.get(f"/api/v1/fits/{fitted}/figures/residual-curve.svg?candidate=nothing").status_code == 404


def test_the_report_is_one_page_that_runs_nothing(service: TestClient, fitted: str) -> None:
    answer = service.get(f"/api/v1/fits/{fitted}/report.html")
    assert answer.headers["content-type"].startswith("text/html")
    assert "script-src" not in answer.headers["content-security-policy"]
    assert "default-src 'none'" in answer.headers["content-security-policy"]
    assert "SW-1" in answer.text


def test_an_approved_set_is_what_the_production_line_finds(service: TestClient, fitted: str) -> None:
    assert service.post(f"/api/v1/fits/{fitted}/approve").json()["current"] is True
    found = service.get("/api/v1/parameter-sets", params={"serial": "SW-1", "Z0.min": "2.5e-6", "Z0.max": "2.7e-6"})
    assert [entry["id"] for entry in found.json()["items"] if entry["current"]] == [fitted]
    none = service.get("/api/v1/parameter-sets", params={"serial": "SW-1", "Z0.min": "2.7e-6"}).json()
    assert fitted not in [entry["id"] for entry in none["items"]]
    assert service.get("/api/v1/actuators/SW-1").json()["current"]["id"] == fitted
    assert service.get("/api/v1/parameter-sets?approved_after=2020-01-01&serial=SW-1").json()["items"]
    assert not service.get("/api/v1/parameter-sets?approved_after=2999-01-01").json()["items"]


def test_an_export_holds_no_formula(service: TestClient, fitted: str) -> None:
    body = dict(files("=1+1"))
    stored = service.post("/api/v1/matrices", files=[("files", item) for item in body.items()]).json()
    job = service.post("/api/v1/fits", json={"matrix": stored["id"], "method": "paper-ga"}).json()["id"]
    assert '"succeeded"' in service.get(f"/api/v1/jobs/{job}/events").text
    text = service.get("/api/v1/parameter-sets?format=csv").text
    assert "'=1+1" in text
    assert ",=1+1" not in text
    table = pq.read_table(io.BytesIO(service.get("/api/v1/parameter-sets?format=parquet").content))
    assert fitted in table.column("id").to_pylist()


def test_a_revision_changes_a_label_and_keeps_the_bytes(service: TestClient, matrix: str) -> None:
    run = service.get(f"/api/v1/matrices/{matrix}").json()["runs"][0]["id"]
    change = {"actuator": {"batch": "B2"}, "runs": {run: {"gain": 6.5}}}
    revised = service.post(f"/api/v1/matrices/{matrix}/revisions", json=change)
    assert revised.status_code == 201
    assert revised.json()["parent"] == matrix
    assert revised.json()["runs"][0]["gain"] == 6.5
    bad = service.post(f"/api/v1/matrices/{matrix}/revisions", json={"runs": {run: {"gain": 0}}})
    assert bad.status_code == 422


def test_a_matrix_tells_what_a_revision_changes(service: TestClient, matrix: str) -> None:
    run = service.get(f"/api/v1/matrices/{matrix}/description").json()["runs"][1]
    change = {"runs": {run["id"]: {"channels": {"displacement": {"invert": True}}}}}
    revised = service.post(f"/api/v1/matrices/{matrix}/revisions", json=change).json()
    now = service.get(f"/api/v1/matrices/{revised['id']}/description").json()["runs"][1]
    assert now["channels"]["displacement"] == {**run["channels"]["displacement"], "invert": "true"}
    assert service.get("/api/v1/matrices/none/description").status_code == 404


@pytest.mark.full
def test_the_report_comes_as_page_and_as_pdf(service: TestClient, fitted: str) -> None:
    page, paper = (service.get(f"/api/v1/fits/{fitted}/report.{kind}") for kind in ("html", "pdf"))
    assert page.text.startswith("<!doctype html>")
    assert paper.headers["content-type"] == "application/pdf"
    assert paper.content.startswith(b"%PDF-")
    assert service.get("/api/v1/fits/none/report.pdf").status_code == 404


def test_each_run_has_a_small_picture(service: TestClient, matrix: str) -> None:
    runs = service.get(f"/api/v1/matrices/{matrix}").json()["runs"]
    answers = [service.get(f"/matrices/{matrix}/thumbnails/{place}.svg") for place in range(len(runs) + 1)]
    assert [answer.status_code for answer in answers] == [200] * len(runs) + [404]
    assert {answer.headers["content-type"] for answer in answers[:-1]} == {"image/svg+xml"}
    assert max(len(answer.content) for answer in answers[:-1]) < 3000
    assert len({answer.text for answer in answers[:-1]}) == len(runs)


def test_the_page_of_a_whole_matrix_is_small(service: TestClient, tmp_path: Path) -> None:
    simulate_matrix(tmp_path / "matrix", seconds=0.25, seed=1)
    stored = service.post(
        "/api/v1/matrices",
        files=[
            ("files", (str(path.relative_to(tmp_path / "matrix")), path.read_bytes()))
            for path in sorted((tmp_path / "matrix").rglob("*"))
            if path.is_file()
        ],
    ).json()
    page = service.get(f"/matrices/{stored['id']}")
    assert page.text.count('id="run-') == 84
    assert len(page.content) < 200_000


def test_a_running_job_is_cancelled_and_leaves_no_fit(service: TestClient, matrix: str) -> None:
    body = {"matrix": matrix, "options": {"generations": 5000}}
    job = service.post("/api/v1/fits", json=body).json()["id"]
    reached(service, job, '"running"')
    service.delete(f"/api/v1/jobs/{job}")
    assert '"state":"cancelled"' in service.get(f"/api/v1/jobs/{job}/events").text
    assert service.get(f"/api/v1/fits/{job}").status_code == 404


def test_the_same_key_is_answered_once(service: TestClient, matrix: str) -> None:
    body, headers = {"matrix": matrix, "seed": 7, "method": "paper-ga"}, {"Idempotency-Key": "once"}
    first = service.post("/api/v1/fits", json=body, headers=headers)
    second = service.post("/api/v1/fits", json=body, headers=headers)
    assert first.json()["id"] == second.json()["id"]
    other = service.post("/api/v1/fits", json=body | {"seed": 8}, headers=headers)
    assert (other.status_code, other.json()["code"]) == (409, "key-in-use")


def test_models_come_with_their_mathematics(service: TestClient) -> None:
    models = {model["name"]: model for model in service.get("/api/v1/models").json()}
    assert "m^4/s" in models["qian2014"]["parameters"][0]["unit"]
    assert all("<math" in equation["mathml"] for equation in models["qian2014"]["equations"])
    assert service.get("/api/v1/effects").status_code == 200


def test_pages_of_a_list_meet_without_overlap(service: TestClient, fitted: str) -> None:
    seen, cursor = [], None
    while True:
        page = service.get("/api/v1/jobs", params={"limit": 1, **({"cursor": cursor} if cursor else {})}).json()
        seen += [job["id"] for job in page["items"]]
        cursor = page["next"]
        if cursor is None:
            break
    assert len(seen) == len(set(seen)) >= 1
    assert fitted in seen
    assert service.get("/api/v1/jobs?cursor=nonsense").status_code == 422

"""What was measured over HTTP: its signals and spectra before any fit."""

from __future__ import annotations

from pathlib import Path

from app.matrices import levels
from tests.app.conftest import zipped

API = "/api/v1"


def test_signals_and_spectra_of_runs_are_drawn_before_any_fit(service, matrix):
    first, second = (run["id"] for run in service.get(f"{API}/matrices/{matrix}").json()["runs"][:2])
    asked = {"run": [first, second], "start": "0.1", "seconds": "0.2"}
    answer = service.get(f"{API}/matrices/{matrix}/figures/signals.json", params=asked)
    assert answer.status_code == 200, answer.text
    rows = answer.json()["datasets"]["channel1"]
    assert {row["r"] for row in rows} == {first, second}
    assert 0.0996 < min(row["t"] for row in rows) < max(row["t"] for row in rows) < 0.3004
    assert service.get(f"{API}/matrices/{matrix}/figures/spectra.json").status_code == 200


def test_what_cannot_be_drawn_says_why(service, matrix):
    wrong = service.get(f"{API}/matrices/{matrix}/figures/signals.json", params={"run": "nobody"})
    assert (wrong.status_code, wrong.json()["code"]) == (422, "unknown-run")
    assert service.get(f"{API}/matrices/nobody/figures/signals.svg").status_code == 404
    assert service.get(f"{API}/matrices/{matrix}/figures/signals.gif").status_code == 404


def test_the_page_of_a_data_set_leads_to_its_signals_and_the_runs_that_are_ticked_are_drawn(service, matrix):
    ids = [run["id"] for run in service.get(f"{API}/matrices/{matrix}").json()["runs"]]
    assert f"/matrices/{matrix}/signals?run={ids[1]}" in service.get(f"/matrices/{matrix}").text
    alone = service.get(f"/matrices/{matrix}/signals", params={"run": ids[1]}).text
    assert f'data-fixed="run={ids[1]}"' in alone
    assert "Use only the range shown" in alone
    both = service.get(f"/matrices/{matrix}/signals", params={"run": ids[:2]}).text
    assert both.count(" checked>") == 2
    assert "Use only the range shown" not in both
    assert service.get(f"/matrices/{matrix}/signals", params={"run": "nobody"}).status_code == 404
    assert service.get(f"/matrices/{matrix}/signals", params={"run": ids[:1] * 9}).status_code == 422


def test_a_range_and_a_trend_of_a_run_are_a_revision(service, matrix):
    """What the page sends: the rows of the file that are shown, and what is removed."""
    name = service.get(f"{API}/matrices/{matrix}").json()["runs"][0]["id"]
    change = {"runs": {name: {"rows": [100, 1500], "trend": "line"}}}
    made = service.post(f"{API}/matrices/{matrix}/revisions", json=change)
    assert made.status_code == 201, made.text
    assert made.json()["runs"][0]["samples"] == 1400
    entry = service.get(f"{API}/matrices/{made.json()['id']}/description").json()["runs"][0]
    assert (entry["rows"], entry["trend"]) == ([100, 1500], "line")


def test_a_run_is_split_by_a_revision_and_the_split_is_taken_back_from_either_part(service, matrix):
    """Its validation data are a run of their own, which no fit uses; the notice says the gap."""
    name = service.get(f"{API}/matrices/{matrix}").json()["runs"][0]["id"]
    split = {"split": {"validation": [1400, 2048], "gap": "20 ms"}}
    made = service.post(f"{API}/matrices/{matrix}/revisions", json={"runs": {name: split}}).json()
    runs = {run["id"]: (run["use"], run["samples"]) for run in made["runs"]}
    assert runs[f"{name}.validation"] == ("verify", 648)
    assert runs[name] == ("fit", 1400 - round(0.02 * 4096))
    assert any("a gap of 0.02 s" in notice for notice in made["notices"])
    back = service.post(
        f"{API}/matrices/{made['id']}/revisions", json={"runs": {f"{name}.validation": {"split": None}}}
    )
    assert [run["samples"] for run in back.json()["runs"] if run["id"].startswith(name)] == [2048]


def test_a_large_matrix_is_drawn_from_levels_that_are_stored_once(service, monkeypatch):
    """As its samples would be; made at the first look where an upload made none; no revision has those of another."""
    monkeypatch.setattr(levels, "LARGE", 1 << 60)
    made = service.post(f"{API}/matrices", files={"files": ("m.zip", zipped("LEVELS-1"))}).json()
    at, storage = f"{API}/matrices/{made['id']}", Path(service.app.state.context.storage.folder)
    blobs = set(storage.glob("??/*"))
    asked = {"start": "0.1", "seconds": "0.2", "run": made["runs"][1]["id"]}
    plain = service.get(f"{at}/figures/signals.json", params=asked).json()
    monkeypatch.setattr(levels, "LARGE", 1)
    for _ in range(2):
        drawn = service.get(f"{at}/figures/signals.json", params=asked | {"share": "1.1"}).json()
        (blob,) = set(storage.glob("??/*")) - blobs
        assert blob.read_bytes().startswith(b"servoident levels")
    for of_samples, of_levels in zip(plain["datasets"]["channel1"], drawn["datasets"]["channel1"], strict=True):
        assert of_samples["t"] == of_levels["t"]
        assert abs(of_samples["y"] - of_levels["y"]) < 1e-3
    assert service.get(f"{at}/figures/spectra.json").status_code == 200
    assert "<path" in service.get(f"/matrices/{made['id']}/thumbnails/1.svg").text
    change = {"runs": {made["runs"][0]["id"]: {"rows": [100, 1500]}}}
    revised = service.post(f"{at}/revisions", json=change).json()
    assert len(set(storage.glob("??/*")) - blobs) == 3  # its description, and levels of its own
    shown = service.get(f"{API}/matrices/{revised['id']}/figures/signals.json").json()
    assert max(row["t"] for row in shown["datasets"]["channel0"]) < 1400 / 4096

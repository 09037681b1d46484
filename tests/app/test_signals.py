"""What was measured over HTTP: its signals and spectra before any fit."""

from __future__ import annotations

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

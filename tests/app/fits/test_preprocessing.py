"""Steps of preprocessing are switched off by a request and by the boxes of the form, and the stored fit says so."""

from __future__ import annotations

import re

from ident.preprocessing import NAMES

API = "/api/v1"
HELD = {"Z0": 2.592e-6, "tau": 3.6e-3, "Cl": 1e-11, "c0": 3200.0, "m0": 4.25, "Ka": 1.39e-13}


def test_a_stored_fit_says_which_steps_were_applied_and_which_were_switched_off(service, matrix):
    """And what comes from it keeps the switches: an effect that is added, a diagnosis, a fit that goes on."""
    asked = {"matrix": matrix, "model": "qian2014", "set": HELD, "preprocessing": {"initial_state": False}}
    job = service.post(f"{API}/fits", json={**asked, "preprocessing": {**asked["preprocessing"], "force_sign": True}})
    assert job.status_code == 202, job.text
    assert '"state":"succeeded"' in service.get(f"{API}/jobs/{job.json()['id']}/events").text
    found = service.get(f"{API}/fits/{job.json()['id']}").json()["result"]
    assert found["settings"]["preprocessing"] == {"initial_state": False}
    states = {one["step"]: one["state"] for one in found["preprocessing"]}
    assert tuple(states) == NAMES
    assert {name for name, state in states.items() if state == "off"} == {"initial_state"}
    page = service.get(f"/fits/{job.json()['id']}", headers={"Accept": "text/html"}).text
    assert "The step initial_state of preprocessing is switched off" in page
    later = [
        service.post(f"{API}/fits", json={"matrix": matrix, "start": {"fit": job.json()["id"]}}),
        service.post(f"{API}/fits/{job.json()['id']}/effects", json={"effect": "dead_zone"}),
        service.post(f"{API}/diagnoses", json={"fit": job.json()["id"], "max_effects": 0, "time": 0.01}),
    ]
    for answer in later:
        assert answer.status_code == 202, answer.text
        assert answer.json()["settings"]["preprocessing"] == {"initial_state": False}
        service.delete(f"{API}/jobs/{answer.json()['id']}")


def test_the_form_that_starts_a_fit_has_a_box_for_each_step(service, matrix):
    """All are checked: nothing is switched off unless somebody says so."""
    page = service.get(f"/matrices/{matrix}", headers={"Accept": "text/html"}).text
    boxes = re.findall(r'<input type="checkbox" name="preprocessing" value="(\w+)" checked>', page)
    assert tuple(boxes) == NAMES


def test_a_switch_is_true_or_false(service, matrix):
    body = {"matrix": matrix, "model": "qian2014", "preprocessing": {"initial_state": "no"}}
    answer = service.post(f"{API}/fits", json=body)
    assert answer.status_code == 422
    assert "preprocessing.initial_state" in answer.text

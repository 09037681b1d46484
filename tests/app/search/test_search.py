"""A text is found in serial numbers, batches, ids, names, tags and notes; its signs are signs."""

from __future__ import annotations

import pytest

API = "/api/v1"


@pytest.fixture(autouse=True)
def written(service, fitted):
    """What is written on the fit, while a test runs."""
    about = {"name": "Cold oil", "tags": ["Prüfung 100%", "acceptance"], "note": "valve_3"}
    service.put(f"{API}/fits/{fitted}/annotation", json=about).raise_for_status()
    yield
    service.put(f"{API}/fits/{fitted}/annotation", json={})


@pytest.mark.parametrize("text", ["cold OIL", " oil ", "Prüfung", "100%", "acceptance", "valve_3"])
def test_a_fit_is_found_by_what_is_written_on_it(service, fitted, text):
    (found,) = service.get(f"{API}/search", params={"q": text}).json()["fits"]
    assert (found["fit"], found["serial"], found["name"]) == (fitted, "SW-1", "Cold oil")
    assert f'<a href="/fits/{fitted}">Cold oil</a>' in service.get("/search", params={"q": text}).text


@pytest.mark.parametrize("text", ["valve%3", "valve-3", "1000%", "c_ld", '"', ", ", "[", "", "   "])
def test_signs_of_a_pattern_are_signs_and_an_empty_text_finds_nothing(service, text):
    assert service.get(f"{API}/search", params={"q": text}).json()["fits"] == []
    assert service.get("/search", params={"q": text}).status_code == 200


def test_actuators_and_ids_are_found(service, matrix, fitted):
    found = service.get(f"{API}/search", params={"q": "sw-1"}).json()
    assert [one["serial"] for one in found["actuators"]] == ["SW-1"]
    assert [one["fit"] for one in service.get(f"{API}/search", params={"q": fitted[:10]}).json()["fits"]] == [fitted]
    sets = service.get(f"{API}/search", params={"q": matrix[:10]}).json()["data_sets"]
    assert [one["matrix"] for one in sets] == [matrix]
    assert "Nothing holds" in service.get("/search", params={"q": "nobody"}).text
    assert service.get(f"{API}/search", params={"q": "x" * 201}).status_code == 422

"""Name, tags and note of a fit: over HTTP, on the pages, in the audit; who may not write does not."""

from __future__ import annotations

API = "/api/v1"
WRITTEN = {"name": "  cold oil,\nfirst try ", "tags": ["acceptance", " acceptance ", "20 degC", ""], "note": "valve 3"}


def test_what_is_written_on_a_fit_is_read_with_it_and_changes_no_result(service, fitted):
    """Spaces are made one, a tag stands once, empty ones go; the pages show it, and the audit has who did."""
    before = service.get(f"{API}/fits/{fitted}").json()
    service.put(f"{API}/fits/{fitted}/annotation", json={})
    assert service.get(f"{API}/fits/{fitted}/annotation").json()["name"] == ""
    put = service.put(f"{API}/fits/{fitted}/annotation", json=WRITTEN)
    assert put.status_code == 200, put.text
    found = service.get(f"{API}/fits/{fitted}/annotation").json()
    assert (found["name"], found["tags"], found["note"]) == (
        "cold oil, first try",
        ["acceptance", "20 degC"],
        "valve 3",
    )
    assert found["who"]
    assert service.get(f"{API}/fits/{fitted}").json() == before
    page = service.get(f"/fits/{fitted}").text
    assert "cold oil, first try</h1>" in page
    assert "valve 3" in page
    listed = service.get(f"/matrices/{before['matrix']}").text
    assert f'<a href="/fits/{fitted}">cold oil, first try</a>' in listed
    assert '<span class="tagged">20 degC</span>' in listed
    noted = service.get(f"{API}/audit", params={"object": f"fits/{fitted}"}).json()["items"]
    assert noted[0]["action"] == "put_annotation"
    taken = service.put(f"{API}/fits/{fitted}/annotation", json={})
    assert (taken.json()["name"], taken.json()["tags"], taken.json()["note"]) == ("", [], "")


def test_what_cannot_be_written_is_refused(service, fitted):
    for bad in ({"name": "x" * 101}, {"tags": ["x" * 41]}, {"tags": ["x"] * 21}, {"title": "x"}):
        assert service.put(f"{API}/fits/{fitted}/annotation", json=bad).status_code == 422
    assert service.put(f"{API}/fits/nothing/annotation", json={"name": "x"}).status_code == 404
    assert service.get(f"{API}/fits/nothing/annotation").status_code == 404

"""Several fits in one table and one plot, and the profile of a parameter: over HTTP and on the page."""

from __future__ import annotations

import json

import pytest

from app.client import Client


@pytest.fixture(scope="module")
def three(service, matrix):
    """Three fits of a matrix by their ids; the second holds a parameter, the third has an effect."""
    lab = Client("http://127.0.0.1:8000", http=service)
    quick = {"options": {"population": 20, "generations": 2}}
    chosen = ({}, {"set": {"tau": "3 ms"}}, {"effects": ["dead_zone"]})
    return [lab.fit(matrix, **quick, **one).id for one in chosen]


def test_each_fit_is_a_column_with_what_it_was_stored_with(service, three):
    found = service.get(f"/api/v1/fits/{three[0]}/beside", params={"other": three[1:]}).json()
    assert [(one["fit"], one["name"]) for one in found["fits"]] == list(zip(three, "ABC", strict=True))
    for one in found["fits"]:
        stored = service.get(f"/api/v1/fits/{one['fit']}").json()["result"]
        assert one["error"] == stored["error"]
        assert {run["id"]: run["error"][one["name"]] for run in found["runs"]} == {
            run["id"]: run["error"] for run in stored["runs"]
        }
    assert found["fits"][1]["parameters"]["tau"]["value"] == 3e-3
    assert "dead_zone.half_width" in found["fits"][2]["parameters"]


def test_one_plot_has_them_all(service, three):
    url = f"/api/v1/fits/{three[0]}/figures/side-by-side"
    rows = json.loads(service.get(f"{url}.json", params={"other": three[1:]}).content)["datasets"]["errors"]
    assert len(rows) == 3 * 9
    assert len({row["f"] for row in rows}) == 3
    assert service.get(f"{url}.svg", params={"other": three[1]}).content.startswith(b"<svg")
    refused = service.get(f"{url}.svg")
    assert refused.status_code == 422
    assert "give 2 to 8" in refused.text


def test_the_page_has_them_all_and_leaves_one_out_or_adds_one(service, three):
    page = service.get("/compare", params={"fits": ",".join(three)}).text
    assert "3 fits side by side" in page
    assert f'href="/compare?fits={three[0]},{three[2]}">remove' in page
    assert "dead_zone.half_width" in page
    two = service.get("/compare", params={"fits": ",".join(three[:2])}).text
    assert f'value="{three[0]},{three[1]},{three[2]}"' in two
    assert service.get("/compare", params={"fits": three[0]}).status_code == 422


@pytest.mark.full
def test_the_profile_of_a_parameter_holds_its_estimate(service, three):
    found = service.get(f"/api/v1/fits/{three[0]}/profile", params={"parameter": "tau"}).json()
    estimate = service.get(f"/api/v1/fits/{three[0]}").json()["result"]["parameters"]["tau"]
    assert found["lower"] < estimate["value"] < found["upper"]


def test_the_profile_of_a_model_with_effects_is_made_by_a_job(service, three):
    """Before it is refused with what to do; then numbers and figure are there, and the page of the job leads to it."""
    url = f"/api/v1/fits/{three[2]}"
    for path in (f"{url}/profile", f"{url}/figures/profile.svg"):
        refused = service.get(path, params={"parameter": "tau"})
        assert refused.status_code == 422
        assert "POST to /fits/ID/profiles" in refused.text
    assert service.post(f"{url}/profiles", json={"parameter": "nothing"}).status_code == 422
    job = service.post(f"{url}/profiles", json={"parameter": "tau"}).json()["id"]
    assert '"state":"succeeded"' in service.get(f"/api/v1/jobs/{job}/events").text
    found = service.get(f"{url}/profile", params={"parameter": "tau"}).json()
    estimate = service.get(url).json()["result"]["parameters"]["tau"]
    assert found["values"][0] < estimate["value"] < found["values"][-1]
    assert min(found["deviance"]) == 0
    assert service.get(f"{url}/figures/profile.svg", params={"parameter": "tau"}).content.startswith(b"<svg")
    assert service.get(f"/fits/{job}", follow_redirects=False).headers["location"] == f"/fits/{three[2]}#profile"


def test_a_profile_is_a_figure_in_every_form_and_on_the_page(service, three):
    """Its interval is that of the numbers; of a model with effects the page has a button that makes it."""
    url = f"/api/v1/fits/{three[0]}/figures/profile"
    found = service.get(f"/api/v1/fits/{three[0]}/profile", params={"parameter": "tau"}).json()
    chart = json.loads(service.get(f"{url}.json", params={"parameter": "tau"}).content)
    assert [row["d"] for row in chart["datasets"]["profile"]] == pytest.approx(found["deviance"], rel=1e-4, abs=1e-4)
    estimate = service.get(f"/api/v1/fits/{three[0]}").json()["result"]["parameters"]["tau"]["value"]
    shown = [row["v"] for row in chart["datasets"]["profile"]]
    assert shown == pytest.approx([1e3 * value for value in found["values"]])  # ms
    assert shown[0] < 1e3 * estimate < shown[-1]
    for kind, start in (("svg", b"<svg"), ("png", b"\x89PNG"), ("pdf", b"%PDF")):
        assert service.get(f"{url}.{kind}", params={"theme": "dark"}).content.startswith(start)
    assert service.get(f"{url}.svg", params={"points": 3}).status_code == 422
    assert f'data-url="{url}"' in service.get(f"/fits/{three[0]}").text
    linear = service.get(f"/fits/{three[0]}").text
    assert "data-profile=" not in linear
    assert "data-unmade=" not in linear
    nonlinear = service.get(f"/fits/{three[2]}").text
    assert f'data-profile="/api/v1/fits/{three[2]}/profiles"' in nonlinear
    assert 'data-unmade="No profile of this parameter is computed yet."' in nonlinear


def test_beside_eq_17_stands_what_is_left_in_the_unit_of_the_output(service, three):
    """Those of the comparison; on the page a cell for each use and each run."""
    found = service.get(f"/api/v1/fits/{three[0]}/error-sizes").json()
    compared = service.get(f"/api/v1/fits/{three[0]}/compare").json()["runs"]
    assert {name: (one["rmse"], one["mae"], one["unit"]) for name, one in found["runs"].items()} == {
        run["id"]: (run["rmse"], run["mae"], run["unit"]) for run in compared
    }
    fitted = [run["rmse"] for run in compared if run["use"] == "fit"]
    assert found["uses"]["fit"]["rmse"] == pytest.approx(sum(fitted) / len(fitted))
    assert found["uses"]["fit"]["rmse_in_print"].endswith("m")
    page = service.get(f"/fits/{three[0]}").text
    assert found["uses"]["fit"]["rmse_in_print"] in page
    for run in compared:
        assert f'data-size="run:{run["id"]}" data-of="rmse"' in page


def test_a_fit_that_ran_out_of_its_budget_says_so_and_has_no_button_to_approve(service, matrix, three):
    """The form asks for a budget; the note, the reason in the button's place, and the refusal over HTTP."""
    lab = Client("http://127.0.0.1:8000", http=service)
    short = lab.fit(matrix, budget=1e-3).id
    page = service.get(f"/fits/{short}").text
    assert "The search ended at generation" in page
    assert "its time limit ended the search" in page
    assert "data-approve" not in page
    assert "data-approve" in service.get(f"/fits/{three[0]}").text
    assert service.post(f"/api/v1/fits/{short}/approve").status_code == 409
    assert 'name="budget"' in service.get(f"/matrices/{matrix}").text

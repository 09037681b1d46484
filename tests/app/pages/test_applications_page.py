"""The page that puts a fit to use: what its forms ask, what it refuses and where, and what nobody else may send."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.pages.control_view import ControlView
from app.pages.hybrid_view import hybrid_view
from app.pages.what_if_request import what_if_request
from app.pages.what_if_view import what_if_form
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.presets.strano import STRANO
from tests.app.test_diagnoses import ended

API = "/api/v1"


@pytest.fixture(scope="module")
def fit(service, fitted):
    return FitResult.from_json(service.get(f"{API}/fits/{fitted}").json()["result"])


def page(service, fitted, **query):
    return service.get(f"/fits/{fitted}/use", params=query)


def test_a_form_that_is_filled_in_is_the_request_of_the_service():
    """Sizes in SI, parameters as they are written, both gains, the axes at either; what is empty is left out."""
    given = {
        "ask": "what-if", "area": "239 mm^2", "stroke": " ", "set.tau": "2 ms", "fitted.stroke": "6 in", "mass": "2 kg",
        "gain_from": "2", "gain_to": "3", "peak": "45 Hz", "axes_to": "0.5:2", "seed": "7",
    }  # fmt: skip
    request = what_if_request(given).model_dump(exclude_defaults=True)
    assert request["set"] == {"area": pytest.approx(239e-6), "tau": "2 ms"}
    assert request["fitted"] == {"stroke": pytest.approx(0.1524)}
    assert request["specimen"] == {"mass": 2.0}
    assert request["gain"] == (2.0, 3.0)
    assert (request["peak"], request["seed"]) == (45.0, 7)
    assert request["axes"] == [{"gain": 3.0, "lower": 0.5, "upper": 2.0}]
    assert what_if_request({"ask": "what-if"}).model_dump(exclude_defaults=True) == {}


@pytest.mark.parametrize(
    ("given", "where"),
    [
        ({"area": "239"}, "area"),
        ({"stiffness": "30 kg"}, "stiffness"),
        ({"peak": "45"}, "peak"),
        ({"gain_from": "two"}, "gain"),
        ({"axes_from": "0.5:1"}, "axes"),
        ({"gain_from": "2", "axes_from": "0.5"}, "axes"),
        ({"seed": "-1"}, "seed"),
        ({"seed": "9" * 12}, "seed"),
    ],
)
def test_what_is_no_quantity_is_refused_by_the_name_of_its_field(given, where):
    with pytest.raises(Unusable) as refused:
        what_if_request(given)
    assert where in refused.value.where
    assert refused.value.remedy


@pytest.mark.parametrize(
    ("query", "said"),
    [
        ({"ask": "what-if", "area": "239"}, "unit"),
        ({"ask": "what-if", "stroke": "4 in"}, "stroke"),
        ({"ask": "what-if", "set.nothing": "1"}, "nothing"),
        ({"ask": "what-if", "gain_from": "3", "gain_to": "2"}, "gain"),
        ({"ask": "tracking", "run": "none"}, "no run"),
        ({"ask": "tracking", "noise": "1 kg"}, "noise"),
    ],
)
def test_a_section_says_why_it_has_no_answer_and_keeps_what_was_written(query, said, service, fitted):
    answer = page(service, fitted, **query)
    assert answer.status_code == 422
    alerts = [part.partition("<")[0] for part in answer.text.split('role="alert">')]
    assert any(said in alert for alert in alerts), alerts
    if "area" in query:
        assert 'value="239"' in answer.text


def test_an_answer_has_its_figures_and_its_numbers(service, fitted):
    """The page names addresses, and each of them answers."""
    query = {"ask": "what-if", "area": "239 mm^2", "gain_from": "2", "gain_to": "3"}
    text = page(service, fitted, **query).text.partition('id="what-if"')[2]  # simulations of others stand before it
    assert "∝ A" in text
    assert "unstable" not in text
    numbers = service.get(f"/fits/{fitted}/use/what-if.json", params=query)
    assert [one["gain"] for one in numbers.json()["responses"]] == [2.0, 3.0]
    for name in ("response", "root-locus"):
        address = text.split(f"/what-if/figures/{name}.pdf")[1].partition('"')[0]
        found = service.get(f"{API}/fits/{fitted}/what-if/figures/{name}.pdf{address.replace('&amp;', '&')}")
        assert found.content.startswith(b"%PDF")


def test_an_unstable_loop_is_an_alert_with_its_cause(service, fitted):
    text = page(service, fitted, ask="what-if", gain_from="200", before_gain="2").text
    alert = text.split('stability" role="alert">')[1].partition("</div>")[0]
    assert "Unstable at Kp = 200" in alert
    assert "The cause is the gain" in alert


def test_a_gain_is_chosen_on_the_page(service, fitted):
    text = page(service, fitted, ask="what-if", choose="phase_margin", choose_value="60").text
    assert "gives a phase margin of 60 °" in text
    assert '<option value="phase_margin" selected>' in text


def test_what_is_written_into_a_field_stays_text(service, fitted):
    answer = page(service, fitted, ask="what-if", area='"><script>x()</script>')
    assert answer.status_code == 422
    assert "<script>x()" not in answer.text


@pytest.mark.parametrize("query", [{"controller": "none"}, {"simulation": "none"}])
def test_what_is_not_stored_is_not_found(query, service, fitted):
    assert page(service, fitted, **query).status_code == 404
    assert service.get("/fits/none/use").status_code == 404


def test_a_job_leads_to_the_simulation_that_it_made(service, fitted):
    """With the words for what was compared, and no controller but those that the model can have."""
    ground = {"kind": "sine", "duration": "0.3 s"}
    job = ended(service, service.post(f"{API}/hybrid-simulations", json={"fit": fitted, "ground": ground}))
    led = service.get(f"/jobs/{job['id']}")
    assert str(led.url).endswith(f"/fits/{fitted}/use?simulation={job['id']}#hybrid")
    assert "measured against reference" in led.text
    assert "sine of 1 Hz" in led.text
    assert led.text.count("/figures/displacement.svg") >= 1


def test_the_simulation_of_one_fit_is_not_shown_by_another(service, fitted, matrix):
    asked_of = service.post(f"{API}/fits", json={"matrix": matrix, "seed": 41, "options": {"generations": 2}})
    other = ended(service, asked_of)["id"]
    made = service.get(f"{API}/hybrid-simulations", params={"fit": fitted}).json()["items"]
    job = made[0]["id"] if made else fitted
    assert page(service, other, simulation=job).status_code == 404


def test_feedforward_is_that_of_a_shaking_table_where_the_model_cannot_be_inverted_sample_by_sample(fit):
    def offered(of):
        return {choice.value: choice.text for choice in hybrid_view(of, [], None, None, ControlView(None)).controllers}

    assert offered(fit)["feedforward"] == "feedforward, of a shaking table"
    assert offered(replace(fit, model=STRANO.name))["feedforward"] == "feedforward from the inverse of the model"
    assert {"none", "kalman"} <= offered(fit).keys()


def test_a_fit_of_a_bench_offers_no_effects_and_no_gain(fit):
    bench = replace(fit, model="kononykhin", effects=(), parameters={})
    assert hybrid_view(bench, [], None, None, ControlView(None)).effects == ()
    assert not what_if_form(bench, {}).has_gain


def test_a_description_is_read_as_the_command_line_reads_it(service):
    """YAML without tags and aliases; what cannot be read is a problem document with its line."""
    read = service.post("/use/reading", json={"text": "gain: 2\nstructure: {mass: 1 kg}", "where": "case"})
    assert read.json() == {"gain": 2, "structure": {"mass": "1 kg"}}
    refused = service.post("/use/reading", json={"text": "a: &x 1\nb: *x", "where": "case"})
    assert refused.status_code == 422
    assert refused.json()["code"] == "yaml-alias"
    assert "case line" in refused.json()["where"]


def test_another_site_s_page_may_not_send(service):
    sent = service.post("/use/reading", json={"text": "a: 1", "where": "case"}, headers={"Origin": "http://evil.test"})
    assert sent.status_code == 403

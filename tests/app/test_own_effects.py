"""A lab's own catalogue over HTTP: kept under a name, found by it, ranked when asked, dropped."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Barrier
from typing import Any

import pytest
from fastapi.testclient import TestClient

from app.context import Context
from app.errors import Failure
from app.own_effects import service as own_effects
from schemas.catalogue import OwnEffectRequest, OwnEffectView
from tests.app.test_custom_effects import OWN
from tests.app.test_diagnoses import ended
from tests.app.test_idempotency import context_of
from tests.hidden_bump import NOISE, zipped

API = "/api/v1"
AT = f"{API}/own-effects"
OF_BENCH = {
    "place": "valve",
    "equation": "q = q - clip(q, -h, h)",
    "strength": {"symbol": "h", "unit": "1", "lower": 0, "upper": 0.1},
}


@pytest.fixture(autouse=True)
def _none_is_left(service: TestClient) -> Iterator[None]:
    """Each test keeps its own."""
    yield
    for one in service.get(AT).json()["items"]:
        assert service.delete(f"{AT}/{one['name']}").status_code == 204


@pytest.fixture(scope="module")
def fitted(service: TestClient) -> str:
    """A fit that lacks a hill of the flow gain."""
    stored = service.post(f"{API}/matrices", files={"files": ("m.zip", zipped())}).json()
    job = ended(service, service.post(f"{API}/fits", json={"matrix": stored["id"]}))
    assert job["state"] == "succeeded", job
    return str(job["fit"])


@pytest.fixture(scope="module")
def found(service: TestClient, fitted: str) -> dict[str, Any]:
    """A diagnosis that proposes a term for it."""
    asked = {"fit": fitted, "max_effects": 0, "propose": True}
    job = ended(service, service.post(f"{API}/diagnoses", json=asked))
    assert job["state"] == "succeeded", job
    answer: dict[str, Any] = service.get(f"{API}/diagnoses/{job['diagnosis']}").json()
    assert len(answer["proposals"]) == 1
    return answer


def keep(service: TestClient, name: str, definition: Any = OWN, **more: Any) -> Any:
    """Ask for a definition to be kept."""
    return service.post(AT, json={"name": name, "definition": definition, **more})


def test_a_definition_is_kept_under_a_name(service: TestClient) -> None:
    """Its parameters follow the name; it is told as an effect of the catalogue is."""
    made = keep(service, "lapped", meaning="lands and ports overlap")
    assert made.status_code == 201, made.text
    assert made.headers["Location"] == f"{AT}/lapped"
    kept = service.get(made.headers["Location"]).json()
    assert kept == made.json()
    assert (kept["name"], kept["definition"]["name"], kept["meaning"]) == (
        "lapped",
        "lapped",
        "lands and ports overlap",
    )
    assert (kept["origin"], kept["diagnosis"], kept["class"], kept["model"]) == ("written", None, [], None)
    assert kept["parameters"][0]["unit"] == "m"
    assert kept["equations"][0]["mathml"].startswith("<math")
    assert kept["version"]
    assert kept["created_at"]


def test_the_same_again_is_no_news_and_another_is_refused(service: TestClient) -> None:
    assert keep(service, "lapped").status_code == 201
    assert keep(service, "lapped", OWN | {"name": "called_otherwise"}).status_code == 200
    answer = keep(service, "lapped", OWN | {"equation": "w = w - 2 * clip(w, -h, h)"})
    assert (answer.status_code, answer.json()["code"]) == (409, "name-in-use")
    assert "DELETE" in answer.json()["remedy"]
    assert service.get(f"{AT}/lapped").json()["definition"]["equation"] == OWN["equation"]


def test_a_retry_with_its_key_is_answered_as_the_first_time(service: TestClient) -> None:
    answers = [
        service.post(AT, json={"name": "lapped", "definition": OWN}, headers={"Idempotency-Key": "k-own"})
        for _ in range(2)
    ]
    assert [answer.status_code for answer in answers] == [201, 201]
    assert answers[0].json() == answers[1].json()


def kept_at_once(here: Context) -> None:
    """Of eight that keep the same under one name one is the first, and all see the same."""
    start, asked = Barrier(8), OwnEffectRequest(name="lapped", definition=OWN)

    def one(number: int) -> tuple[OwnEffectView, bool]:
        start.wait(30)
        return own_effects.keep(here, asked, f"id-{number}")

    with ThreadPoolExecutor(8) as pool:
        answers = list(pool.map(one, range(8)))
    assert [new for _, new in answers].count(True) == 1
    assert all(kept == answers[0][0] for kept, _ in answers)
    first = next(number for number, (_, new) in enumerate(answers) if new)
    assert own_effects.kept_as(here, f"id-{first}") == answers[0][0]
    assert own_effects.keep(here, asked, f"id-{first}") == (answers[0][0], True)  # by who takes over a killed claim
    with pytest.raises(Failure) as error:
        own_effects.keep(here, OwnEffectRequest(name="lapped", definition=OWN | {"meaning": "other"}), "id-9")
    assert error.value.status == 409


def test_of_many_at_once_one_keeps_it(tmp_path: Path) -> None:
    here = context_of(tmp_path)
    kept_at_once(here)
    here.engine.dispose()


@pytest.mark.parametrize(
    ("body", "code"),
    [
        ({"name": "dead_zone", "definition": OWN}, "name-taken"),
        ({"name": "tau", "definition": OWN}, "name-taken"),
        ({"name": "clip", "definition": OWN}, "name-taken"),
        ({"name": "my effect", "definition": OWN}, "bad-name"),
        ({"name": "", "definition": OWN}, "bad-name"),
        ({"name": "lapped", "definition": OWN | {"equation": "w = w +"}}, "bad-equation"),
        ({"name": "lapped", "definition": "- 1"}, "not-an-effect"),
        ({"name": "lapped", "definition": OWN, "model": "nothing"}, "unknown-model"),
        ({"name": "lapped"}, "bad-request"),
        ({"name": "lapped", "definition": OWN, "diagnosis": "x"}, "bad-request"),
        ({"name": "lapped", "diagnosis": "none"}, "no-such-diagnosis"),
        ({"name": "lapped", "definition": OWN, "colour": "red"}, "invalid-request"),
    ],
)
def test_what_cannot_be_kept_is_a_problem_with_its_remedy(service: TestClient, body: dict[str, Any], code: str) -> None:
    answer = service.post(AT, json=body)
    assert answer.json()["code"] == code, answer.text
    assert answer.status_code == (404 if code == "no-such-diagnosis" else 422)
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.json()["remedy"]
    assert service.get(AT).json()["items"] == []


def test_they_are_listed_page_by_page_and_by_the_model_that_can_take_them(service: TestClient) -> None:
    """An effect made for a bench's model counts in rated currents: another model does not take it."""
    for name in ("c_lapped", "a_lapped", "b_lapped"):
        keep(service, name)
    assert keep(service, "d_bench", OF_BENCH, model="kononykhin").status_code == 201
    first = service.get(AT, params={"limit": 2}).json()
    rest = service.get(AT, params={"limit": 2, "cursor": first["next"]}).json()
    assert [one["name"] for one in first["items"] + rest["items"]] == ["a_lapped", "b_lapped", "c_lapped", "d_bench"]
    names = {
        model: [one["name"] for one in service.get(AT, params={"model": model}).json()["items"]]
        for model in ("qian2014", "kononykhin", "drive")
    }
    assert names["qian2014"] == ["a_lapped", "b_lapped", "c_lapped"]
    assert "d_bench" in names["kononykhin"]
    assert names["drive"] == []
    assert service.get(AT, params={"model": "nothing"}).status_code == 422
    assert service.get(AT, params={"cursor": "nothing"}).status_code == 422


@pytest.mark.full
def test_a_dropped_effect_is_gone_and_the_fit_that_has_it_stays(service: TestClient, fitted: str) -> None:
    keep(service, "lapped")
    asked = {"effect": "lapped"}
    job = ended(service, service.post(f"{API}/fits/{fitted}/effects", json=asked))
    assert service.delete(f"{AT}/lapped").status_code == 204
    assert service.get(f"{AT}/lapped").status_code == 404
    assert service.delete(f"{AT}/lapped").json()["code"] == "no-such-own-effect"
    result = service.get(f"{API}/fits/{job['fit']}").json()["result"]
    assert result["effects"] == ["lapped"]
    assert "lapped.h" in result["parameters"]
    assert service.get(f"/fits/{job['fit']}").status_code == 200
    assert service.post(f"{API}/fits/{fitted}/effects", json=asked).status_code == 422


def test_what_was_proposed_says_so_wherever_it_goes(service: TestClient, found: dict[str, Any]) -> None:
    """Kept from its diagnosis, and kept again from the definition that a client was given."""
    term = found["proposals"][0]
    made = service.post(AT, json={"name": "hill", "diagnosis": found["id"], "proposal": 0})
    assert made.status_code == 201, made.text
    kept = made.json()
    assert kept["definition"]["equation"] == term["effect"]["equation"]
    assert (kept["name"], kept["definition"]["name"], kept["meaning"]) == ("hill", "hill", term["meaning"])
    assert (kept["origin"], kept["model"], kept["diagnosis"]) == ("proposed by search", "qian2014", found["id"])
    assert (kept["nats"], kept["bar"], kept["class"]) == (term["nats"], term["bar"], term["class"])
    assert (kept["data_hash"], kept["version"]) == (found["data_hash"], found["version"])
    assert keep(service, "hill_again", kept["definition"]).json()["origin"] == "proposed by search"
    answer = service.post(AT, json={"name": "second", "diagnosis": found["id"], "proposal": 1})
    assert (answer.status_code, answer.json()["code"]) == (422, "no-such-proposal")


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_the_next_actuator_has_it_by_name(service: TestClient, found: dict[str, Any]) -> None:
    """In a new fit, in a diagnosis that ranks the lab's own, and in one that names it; else it is not ranked."""
    service.post(AT, json={"name": "hill", "diagnosis": found["id"]})
    stored = service.post(f"{API}/matrices", files={"files": ("m.zip", zipped("BUMP-2"))}).json()
    job = ended(service, service.post(f"{API}/fits", json={"matrix": stored["id"], "effects": ["hill"]}))
    result = service.get(f"{API}/fits/{job['fit']}").json()["result"]
    assert result["effects"] == ["hill"]
    assert result["settings"]["custom"][0]["source"] == "proposed by search"
    assert result["error"]["verify"] < 1.1 * NOISE

    plain = ended(service, service.post(f"{API}/fits", json={"matrix": stored["id"]}))["fit"]
    ranked = {}
    for name, most, asked in (
        ("own", 1, {"own": True}),
        ("named", 1, {"custom": ["hill"]}),
        ("without", 0, {"propose": False}),
    ):
        job = ended(service, service.post(f"{API}/diagnoses", json={"fit": plain, "max_effects": most, **asked}))
        assert job["state"] == "succeeded", job
        ranked[name] = service.get(f"{API}/diagnoses/{job['diagnosis']}").json()
    assert ranked["own"]["candidates"][0]["effect"] == "hill"
    assert ranked["own"]["verdict"]["effects"] == ["hill"]
    assert not ranked["own"]["verdict"]["unexplained"]
    assert ranked["named"]["verdict"]["effects"] == ["hill"]
    assert "hill" not in [one["effect"] for one in ranked["without"]["candidates"]]
    answer = service.post(f"{API}/diagnoses", json={"fit": plain, "custom": ["leek"]})
    assert (answer.status_code, answer.json()["code"]) == (422, "no-such-effect")


@pytest.mark.usefixtures("few_effects")
def test_a_diagnosis_of_a_matrix_ranks_them_once_its_model_is_known(service: TestClient, matrix: str) -> None:
    """What the model cannot take is left out; the fit that is made first stays as it would be without them."""
    keep(service, "lapped")
    keep(service, "of_bench", OF_BENCH, model="kononykhin")
    job = ended(service, service.post(f"{API}/diagnoses", json={"matrix": matrix, "own": True, "max_effects": 1}))
    assert job["state"] == "succeeded", job
    made = service.get(f"{API}/diagnoses/{job['diagnosis']}").json()
    names = [one["effect"] for one in made["candidates"]]
    assert "lapped" in names
    assert "of_bench" not in names
    assert not service.get(f"{API}/fits/{job['fit']}").json()["result"]["settings"].get("custom")


def test_pages_offer_what_is_kept(service: TestClient, found: dict[str, Any], fitted: str) -> None:
    """On the card of the term, in the list of a fit that can take it, on the form that starts one, on a page of all."""
    page = service.get(f"/fits/{fitted}").text
    assert 'value="acts_at_one_part_of_the_way"' in page
    assert "Saved own effects" not in page
    assert 'name="own" type="checkbox"' not in page
    assert "No own effects yet" in service.get("/effects").text
    service.post(AT, json={"name": "hill", "diagnosis": found["id"]})
    keep(service, "of_bench", OF_BENCH, model="kononykhin")
    page = service.get(f"/fits/{fitted}").text
    assert "Saved as hill" in page
    assert 'value="acts_at_one_part_of_the_way"' not in page
    listed = page.partition('aria-labelledby="kept-title"')[2].partition("</section>")[0]
    assert "<b>hill</b>" in listed
    assert "proposed by search" in listed
    assert "of bench" not in listed
    assert 'name="own" type="checkbox"> include' in page
    assert 'value="hill"' in service.get(f"/matrices/{found['matrix']}").text
    everything = service.get("/effects").text
    assert f"proposed by search: {found['proposals'][0]['nats']:.0f} nats" in everything
    assert 'data-drop="/api/v1/own-effects/of_bench"' in everything

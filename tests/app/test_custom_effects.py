"""Effects of users over HTTP: checked, fitted, kept with the fit."""

from __future__ import annotations

import pytest
from fastapi.testclient import TestClient

from app.fits.service import settings_of
from app.pages.fit_page import fit_request
from ident.fit.result import FitResult
from schemas.fit import FitRequest

OWN = {
    "name": "overlap",
    "place": "spool",
    "equation": "w = w - clip(w, -h, h)",
    "strength": {"symbol": "h", "unit": "mm", "lower": 0, "upper": 0.02},
    "meaning": "the lands overlap",
}


def test_a_definition_is_answered_with_its_mathematics_and_units(service: TestClient) -> None:
    """As data, and as the text of a file."""
    text = "name: overlap\nplace: spool\nequation: w = w - clip(w, -h, h)\n"
    text += "strength: {symbol: h, unit: um, lower: 0, upper: 20}\nmeaning: the lands overlap\n"
    first = service.post("/api/v1/custom-effects", json=OWN)
    assert first.status_code == 200, first.text
    assert first.json()["equations"][0]["mathml"].startswith("<math")
    assert first.json()["parameters"][0]["unit"] == "m"
    assert service.post("/api/v1/custom-effects", json=text).json()["equations"] == first.json()["equations"]


@pytest.mark.parametrize(
    ("body", "where"),
    [
        (OWN | {"equation": "w = w - __import__('os')"}, "equation, character 9"),
        ({"name": "x"}, "effect"),
        ({}, "effect name"),
        ("- 1", "effect"),
        (OWN | {"shape": {"T": {}}}, "shape T"),
        (OWN | {"strength": "h"}, "strength"),
    ],
)
def test_a_bad_definition_is_a_problem_with_its_place(service: TestClient, body: object, where: str) -> None:
    """422, problem+json, where and remedy filled in; the same in a fit."""
    answer = service.post("/api/v1/custom-effects", json=body)
    assert answer.status_code == 422
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.json()["where"].startswith(where)
    assert answer.json()["remedy"]


def test_a_fit_with_an_own_effect_is_stored_with_it(service: TestClient, matrix: str) -> None:
    """Queued, fitted, compared and shown from what is stored."""
    body = {"matrix": matrix, "custom": [OWN], "set": {"overlap.h": "0.01 mm"}, "options": {"generations": 1}}
    job = service.post("/api/v1/fits", json=body)
    assert job.status_code == 202, job.text
    fit = job.json()["id"]
    assert '"state":"succeeded"' in service.get(f"/api/v1/jobs/{fit}/events").text
    result = service.get(f"/api/v1/fits/{fit}").json()["result"]
    assert result["effects"] == ["overlap"]
    assert result["settings"]["custom"][0]["equation"] == OWN["equation"]
    compared = service.get(f"/api/v1/fits/{fit}/compare")
    assert compared.status_code == 200
    assert service.get(f"/api/v1/fits/{fit}/budget").json() == compared.json()["budget"]
    assert service.get(f"/fits/{fit}").status_code == 200
    again = FitRequest(matrix=matrix, **fit_request(FitResult.from_json(result), fit))
    assert settings_of(again, None).to_json() == result["settings"]  # what the page sends to fit it again
    assert again.parent == fit
    bad = service.post("/api/v1/fits", json=body | {"custom": [OWN | {"equation": "w = w +"}]})
    assert (bad.status_code, bad.json()["where"]) == (422, "equation, character 8")

"""A change of the API that would break a client is found, and one that would not is none."""

from __future__ import annotations

import copy
from collections.abc import Callable
from functools import cache
from typing import Any

import pytest

from app.main import routed
from tests.contract.breaking import breaks

Json = dict[str, Any]
FITS, SETS, JOB = "/api/v1/fits", "/api/v1/parameter-sets", "/api/v1/jobs/{job}"


@cache
def now() -> Json:
    """The document as it is."""
    return routed().openapi()


def schema(document: Json, name: str) -> Json:
    found: Json = document["components"]["schemas"][name]
    return found


def call(document: Json, path: str, method: str) -> Json:
    found: Json = document["paths"][path][method]
    return found


def parameter(document: Json, name: str) -> Json:
    found: Json = next(each for each in call(document, SETS, "get")["parameters"] if each["name"] == name)
    return found


BREAKING: dict[str, Callable[[Json], object]] = {
    "DELETE /api/v1/jobs/{job}: taken away": lambda d: d["paths"][JOB].pop("delete"),
    "GET /api/v1/models: taken away": lambda d: d["paths"].pop("/api/v1/models"),
    "is called submit, was start_fit": lambda d: call(d, FITS, "post").update(operationId="submit"),
    "role line taken away": lambda d: call(d, SETS, "get")["security"].remove({"token": ["line"]}),
    "was open to anyone": lambda d: call(d, "/api/v1/health", "get").update(security=[{"token": ["admin"]}]),
    "parameter batch: taken away": lambda d: call(d, SETS, "get")["parameters"].remove(parameter(d, "batch")),
    "parameter batch: must now be sent": lambda d: parameter(d, "batch").update(required=True),
    "parameter new: must now be sent": lambda d: call(d, SETS, "get")["parameters"].append(
        {"name": "new", "in": "query", "required": True, "schema": {"type": "string"}}
    ),
    "parameter limit: integer is now string": lambda d: parameter(d, "limit")["schema"].update(type="string"),
    "body.seed: taken away": lambda d: schema(d, "FitRequest")["properties"].pop("seed"),
    "body.seed: must now be sent": lambda d: schema(d, "FitRequest")["required"].append("seed"),
    "body.seed: integer is now string": lambda d: schema(d, "FitRequest")["properties"]["seed"].update(type="string"),
    "answer 202: taken away": lambda d: call(d, FITS, "post")["responses"].pop("202"),
    "text/csv taken away": lambda d: call(d, SETS, "get")["responses"]["200"]["content"].pop("text/csv"),
    "answer 202.state: taken away": lambda d: schema(d, "JobView")["properties"].pop("state"),
    "current.serial: may now be missing": lambda d: schema(d, "ParameterSetView")["required"].remove("serial"),
    "value: number is now string": lambda d: schema(d, "ValueView")["properties"]["value"].update(type="string"),
    "std_error: null or number is now null or number or string": lambda d: schema(d, "ValueView")["properties"][
        "std_error"
    ]["anyOf"].append({"type": "string"}),
}


@pytest.mark.parametrize("told", BREAKING)
def test_what_breaks_a_client_is_found(told: str) -> None:
    changed = copy.deepcopy(now())
    BREAKING[told](changed)
    found = list(breaks(now(), changed))
    assert any(told in line for line in found), found


def test_what_is_added_breaks_nobody() -> None:
    """A call, a role, a field of an answer, a parameter and a field that need not be sent, a kind that is taken."""
    changed = copy.deepcopy(now())
    changed["paths"]["/api/v1/more"] = {"get": call(changed, FITS, "post")}
    call(changed, FITS, "post")["security"].append({"token": ["ci"]})
    schema(changed, "JobView")["properties"]["more"] = {"type": "string"}
    schema(changed, "JobView")["required"].append("more")
    schema(changed, "FitRequest")["properties"]["more"] = {"type": "string"}
    seed = schema(changed, "FitRequest")["properties"]["seed"]
    schema(changed, "FitRequest")["properties"]["seed"] = {"anyOf": [seed, {"type": "string"}]}
    call(changed, SETS, "get")["parameters"].append({"name": "more", "in": "query", "schema": {"type": "string"}})
    assert list(breaks(now(), changed)) == []


def test_a_document_does_not_break_itself() -> None:
    assert list(breaks(now(), copy.deepcopy(now()))) == []

"""The API's document: words for names, and nothing that would break a client of the one that is kept in docs."""

from __future__ import annotations

import json
import re
from functools import cache
from typing import Any

import pytest
from fastapi.openapi.utils import get_openapi

from app.main import routed
from app.openapi import RESULTS
from tests.conftest import ROOT
from tests.contract.breaking import breaks

KEPT: dict[str, Any] = json.loads((ROOT / "docs" / "openapi.json").read_text(encoding="utf-8"))


@cache
def now() -> dict[str, Any]:
    """The document as it is."""
    return routed().openapi()


def calls() -> list[dict[str, Any]]:
    """Every operation of it."""
    return [operation for operations in now()["paths"].values() for operation in operations.values()]


def test_no_client_of_the_kept_document_is_broken() -> None:
    """What would break one is not written into docs/openapi.json either, unless it is asked for."""
    assert list(breaks(KEPT, now())) == [], "keep the call as it was, or: .venv/bin/python docs/generate.py --break"


def test_it_is_written_once_for_all_applications_of_a_process() -> None:
    """It takes two seconds, and no application has other calls."""
    assert routed().openapi() is routed().openapi()


def test_operations_are_called_by_words_each_its_own() -> None:
    ids = [call["operationId"] for call in calls()]
    assert len(set(ids)) == len(ids) > 50
    assert [name for name in ids if not re.fullmatch(r"[a-z]+(_[a-z]+)+", name)] == []


def test_a_problem_is_one_component() -> None:
    """Every refusal refers to it, and no call is without one."""
    reference = {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}
    for call in calls():
        refusals = [answer["content"] for status, answer in call["responses"].items() if int(status) >= 400]
        assert len(refusals) > 5
        assert all(content == reference for content in refusals)
    titled = [name for name, each in now()["components"]["schemas"].items() if each.get("title") == "Problem"]
    assert titled == ["Problem"]


def test_no_two_components_share_a_name() -> None:
    """Else both are called by the module that they are from, which no client wants to read."""
    assert [name for name in now()["components"]["schemas"] if "__" in name] == []


@pytest.mark.parametrize("path", ["/api/v1/fits", "/api/v1/tokens"])
def test_a_call_says_how_it_is_authorised(path: str) -> None:
    assert now()["paths"][path]["post"]["security"][-1] == {"token": ["admin"]}
    assert now()["components"]["securitySchemes"]["token"]["scheme"] == "bearer"


def test_a_result_of_the_library_is_what_a_client_without_the_library_reads() -> None:
    """Each of them is served, and a model of the contract that has its name in the document has its fields."""
    models = get_openapi(title="", version="", routes=routed().routes)["components"]["schemas"]
    assert RESULTS.keys() <= models.keys()
    for own, served in RESULTS.items():
        if served in models:
            assert fields(models[own]) == fields(models[served]), served


def fields(model: dict[str, Any]) -> dict[str, Any]:
    """What the fields of a model hold, without the defaults that a client may leave out."""
    text = json.dumps({name: {**field, "default": None} for name, field in model["properties"].items()})
    for own, served in RESULTS.items():
        text = text.replace(f'/{own}"', f'/{served}"')
    found: dict[str, Any] = json.loads(text)
    return found

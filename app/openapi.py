"""The OpenAPI document: ids of operations are words, Problem is one component, each call says which roles may.

A call may answer with a result of the library, a dataclass: :data:`RESULTS` has what the document calls it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from fastapi import APIRouter, FastAPI, Request
from fastapi.openapi.utils import get_openapi
from fastapi.routing import APIRoute, iter_route_contexts
from pydantic.json_schema import models_json_schema

from app.access.caller import Role
from app.access.roles import READERS, May, declared
from schemas.problem import Problem

router = APIRouter(include_in_schema=False)
_BINARY = {"application/pdf", "application/zip"}
_BYTES = "application/octet-stream"
RESULTS: Mapping[str, str] = {
    "Acceleration": "AccelerationView",
    "Actuator": "SizesView",
    "AmplitudeMargin": "AmplitudeMarginView",
    "Axes": "AxesView",
    "Budget": "ErrorBudget",
    "BulkModulus": "OilView",
    "Carried": "CarriedView",
    "Cause": "CauseView",
    "FactorRange": "FactorRangeView",
    "FeedforwardTracking": "FeedforwardView",
    "DrawnSimulations": "DrawnSimulationsView",
    "Interval": "Spread",
    "JointChange": "JointChangeView",
    "Judgement": "JudgementView",
    "Law": "LawView",
    "Margins": "MarginsView",
    "Mark": "MarkView",
    "Mode": "ModeView",
    "Peak": "PeakView",
    "PeakSearch": "PeakSearchView",
    "PeakTarget": "PeakTargetView",
    "Pole": "PoleView",
    "PositionLoop": "PositionLoopView",
    "Profile": "ProfileView",
    "RefusedRun": "RefusedRunView",
    "Regulator": "RegulatorView",
    "Remedy": "RemedyView",
    "Response": "ResponseView",
    "RigLimits": "RigStated",
    "RootLocus": "RootLocusView",
    "Signal": "PlannedSignalView",
    "Specimen": "SpecimenView",
    "Starts": "JointStartsView",
    "Target": "TargetView",
    "WhatIf": "WhatIfView",
}
"""Results of the library that are served as they are, by their classes: what they are called in the document.

Clients that were generated from the document have classes of these names. A model of `schemas` under the same name is
the same component, for a client that has no library (`tests/contract`).
"""
_BEARER = {"type": "http", "scheme": "bearer", "description": "A token; or the cookie of a session."}


@router.get("/openapi.json", dependencies=[READERS])
def document(request: Request) -> dict[str, Any]:
    """This document."""
    content: dict[str, Any] = request.app.openapi()
    return content


def named(route: APIRoute) -> str:
    """The id of an operation: what its function is called."""
    return route.name


def write(app: FastAPI) -> dict[str, Any]:
    """The document of an application's calls."""
    made = get_openapi(title=app.title, version=app.version, routes=app.routes, webhooks=app.webhooks.routes)
    made = _with_names_of_results(made)
    components = made.setdefault("components", {})
    _, problem = models_json_schema([(Problem, "serialization")], ref_template="#/components/schemas/{model}")
    components.setdefault("schemas", {}).update(problem["$defs"])
    components["securitySchemes"] = {"token": _BEARER}
    found = {each.name: declared(each.original_route) for each in iter_route_contexts(app.routes)}
    for operations in made["paths"].values():
        for operation in operations.values():
            operation["security"] = _security(found[operation["operationId"]])
            for response in operation["responses"].values():
                _add_bytes(response.get("content", {}))
    return made


def _with_names_of_results(document: dict[str, Any]) -> dict[str, Any]:
    """The document with the library's results under the names of :data:`RESULTS`; every field of them is sent."""
    components = document.get("components", {}).get("schemas", {})
    for own, served in RESULTS.items():
        if own not in components:
            continue
        result = components.pop(own)
        for field in result["properties"].values():
            field.pop("default", None)
        components.setdefault(served, {**result, "title": served, "required": list(result["properties"])})
    renamed: dict[str, Any] = _renamed(document)
    return renamed


def _renamed(part: Any) -> Any:
    """A part of the document whose references name results as :data:`RESULTS` does."""
    if isinstance(part, list):
        return [_renamed(entry) for entry in part]
    if not isinstance(part, dict):
        return part
    if isinstance(reference := part.get("$ref"), str):
        place, _, name = reference.rpartition("/")
        return {**part, "$ref": f"{place}/{RESULTS.get(name, name)}"}
    return {name: _renamed(entry) for name, entry in part.items()}


def _add_bytes(content: dict[str, Any]) -> None:
    """What comes as a document or an archive may be taken for plain bytes: few clients know more of it."""
    if content and not content.keys() - _BINARY:
        content.update({kind: {"schema": {"type": "string", "format": "binary"}} for kind in [*content, _BYTES]})


def _security(declaration: May | None) -> list[dict[str, list[str]]]:
    """The roles, each of which will do; none of them for what anyone may ask."""
    if declaration is None or declaration.free:
        return []
    return [{"token": [role]} for role in Role if role in declaration.roles | {Role.ADMIN}]

"""The remedy of a request that its model refuses: the nearest field, or the nearest of the words that a field takes."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, get_args

from fastapi import Request
from pydantic import BaseModel

from ident.words.nearest import did_you_mean

USUAL = "the OpenAPI document lists the fields"


def body_of(request: Request) -> type[BaseModel] | None:
    """The model of the body that a call takes, where it takes one."""
    field = getattr(request.scope.get("route"), "body_field", None)
    return _model(field.field_info.annotation) if field is not None else None


def remedy(error: Mapping[str, Any], body: type[BaseModel] | None) -> str:
    """What to do about one of the errors of a request, the nearest name where a name is not known."""
    if error["type"] == "literal_error":
        return did_you_mean(str(error["input"]), re.findall(r"'([^']*)'", str(error["ctx"]["expected"])), USUAL)
    if error["type"] != "extra_forbidden":
        return USUAL
    *path, name = error["loc"][1:]
    for step in path:
        known = body.model_fields.get(str(step)) if body is not None else None
        body = _model(known.annotation) if known is not None else body
    return did_you_mean(str(name), body.model_fields if body is not None else (), USUAL)


def _model(annotation: Any) -> type[BaseModel] | None:
    """The model in an annotation, as in ``Request | None`` or ``dict[str, Limit]``."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    return next((found for part in get_args(annotation) if (found := _model(part)) is not None), None)

"""/parameter-sets: the production line's query."""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import StreamingResponse

from app.access.roles import READERS
from app.context import Here
from app.errors import COMMON
from app.parameters import service
from schemas.parameters import ParameterSetPage

router = APIRouter(prefix="/parameter-sets", tags=["parameter sets"], responses=COMMON)
_FORMATS: dict[str, dict[str, str]] = {"text/csv": {}, "application/vnd.apache.parquet": {}}


@router.get("", dependencies=[READERS], response_model=ParameterSetPage, responses={200: {"content": _FORMATS}})
def list_parameter_sets(
    request: Request,
    here: Here,
    serial: str | None = None,
    batch: str | None = None,
    model: str | None = None,
    approved_after: str | None = None,
    approved_before: str | None = None,
    approved: bool | None = None,
    current: bool | None = None,
    cursor: str | None = None,
    limit: Annotated[int, Query(ge=1, le=1000)] = 100,
    format: Literal["json", "csv", "parquet"] = "json",  # noqa: A002  the contract's name
) -> ParameterSetPage | Response:
    """Parameter sets, newest first; NAME.min and NAME.max (SI) bound any parameter, such as Z0.min=2e-6."""
    wanted = service.wanted(
        request.query_params,
        serial=serial,
        batch=batch,
        model=model,
        approved_after=approved_after,
        approved_before=approved_before,
        approved=approved,
        current=current,
    )
    if format == "csv":
        return StreamingResponse(service.export.csv_rows(here, wanted), media_type="text/csv")
    if format == "parquet":
        blocks = service.export.parquet_blocks(here, wanted)
        return StreamingResponse(blocks, media_type="application/vnd.apache.parquet")
    return Response(service.page_as_json(here, wanted, cursor, limit), media_type="application/json")

"""Controllers: design, keep, look, as files."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

from sqlalchemy.exc import IntegrityError

from app.access.audited_changes import about
from app.context import Context
from app.errors import Failure, missing
from app.fits import service as fits
from app.hybrid import repository
from app.hybrid.at_condition import moved_to
from app.hybrid.earlier_loop import earlier_case, stated
from app.hybrid.request_parsing import AskedCase, asked_case
from app.hybrid.spread import spread_of
from app.lru import LRU
from app.paging import cursor, keys_of
from app.tables import ControllerRow
from ident.fit.result import FitResult
from ident.hybrid.controller import SampledController
from ident.hybrid.controller_design import ControllerDesign, design_controller, on_case
from ident.hybrid.export import as_header, as_mat
from ident.hybrid.target_loop import QIAN2014_TARGET, target_of
from schemas.hybrid import AtRequest, ControllerRequest, SpreadRequest
from schemas.hybrid_result import ControllerPage, ControllerView, DesignView

FILES = {"json": "application/json", "mat": "application/x-matlab-data", "h": "text/x-c"}
"""Forms of a controller, with their media types."""
_MOST = 8  # designs in memory, for their figures
_designs: LRU[ControllerDesign] = LRU(_MOST)


def design(context: Context, request: ControllerRequest, controller: str) -> ControllerView:
    """Design a controller and keep it under this id. Raises Unusable, and Failure 404 where there is no such fit."""
    case = asked_case(request.case)
    asked = request.model_dump(exclude_none=True) | {"case": case.case, "case_name": case.read(request.part).name}
    asked |= {"before": stated(request.before)} if request.before else {}
    made = _designed(context, asked)
    about(f"controllers/{controller}")
    with context.sessions() as session:
        try:
            repository.add_controller(session, controller, request.fit, asked, made.to_json())
            session.commit()
        except IntegrityError:  # by the process before, which did not live to answer
            session.rollback()
    _designs.put((str(context.storage.folder), controller), made)
    return get(context, controller)


def _designed(context: Context, asked: dict[str, Any]) -> ControllerDesign:
    """The design that is asked for."""
    moved = moved_to(context, _fit(context, asked["fit"]), AtRequest(**asked["at"]) if "at" in asked else None)
    fit = moved.fit
    case = AskedCase(asked["case"], None).read(asked.get("part"))
    asked_spread = SpreadRequest(**asked["spread"]) if "spread" in asked else None
    before = earlier_case(asked.get("before"), fit, case, lambda one: _fit(context, one))
    target = target_of(asked["target"]) if "target" in asked else QIAN2014_TARGET
    made = design_controller(
        fit,
        case.physical,
        sample_rate=case.sample_rate,
        gain=case.gain,
        piston_area=case.piston_area,
        delay=case.delay,
        target=target,
        structure=asked["structure"],
        seed=asked["seed"],
        before=before,
        spread=spread_of(context, asked_spread, fit.model),
    )
    made = on_case(made, fit, case, before)
    return replace(made, notes=(*moved.text, *made.notes))


def _fit(context: Context, fit: str) -> FitResult:
    return FitResult.from_json(fits.find(context, fit).result)


def made_as(context: Context, controller: str) -> ControllerView | None:
    """The controller that was kept under this id."""
    with context.sessions() as session:
        row = repository.controller(session, controller)
    return None if row is None else view(row)


def get(context: Context, controller: str) -> ControllerView:
    """A controller by id; raises Failure 404."""
    return view(find(context, controller))


def listed(context: Context, fit: str | None, after: str | None, limit: int) -> ControllerPage:
    """A page of controllers."""
    with context.sessions() as session:
        rows = repository.controllers(session, fit, keys_of(after, 2), limit)
    following = cursor(rows[-1].created_at, rows[-1].id) if len(rows) == limit else None
    return ControllerPage(items=[view(row) for row in rows], next=following)


def file(context: Context, controller: str, kind: str) -> tuple[bytes, str]:
    """A controller as JSON, as a MAT file or as a C header, and its media type; raises Failure 404."""
    if kind not in FILES:
        raise Failure(404, "no-such-format", f"no controllers as {kind!r}", "controller", f"use {', '.join(FILES)}")
    result = find(context, controller).result
    if kind == "json":
        return json.dumps(result, indent=2).encode(), FILES[kind]
    sampled = SampledController.from_json(result)
    return (as_mat(sampled) if kind == "mat" else as_header(sampled).encode()), FILES[kind]


def designed(context: Context, controller: str) -> tuple[ControllerDesign, str]:
    """The design behind a controller, with its robustness band, and the case; made again where it is not in memory."""
    row = find(context, controller)
    key = (str(context.storage.folder), controller)
    return _designs.get(key, lambda: _designed(context, row.asked)), row.asked["case_name"]


def find(context: Context, controller: str) -> ControllerRow:
    """The record of a controller; raises Failure 404."""
    with context.sessions() as session:
        row = repository.controller(session, controller)
    if row is None:
        raise missing("controller", controller)
    return row


def view(row: ControllerRow) -> ControllerView:
    """A controller as it is sent."""
    held = row.result
    return ControllerView(
        id=row.id,
        fit=row.fit,
        case=row.asked["case_name"],
        created_at=row.created_at,
        name=held["name"],
        sample_rate=held["sample_rate"],
        design=DesignView(**held["design"]),
    )

"""/regressions: recheck approved actuators over all workers."""

from __future__ import annotations

from typing import Literal

from fastapi import APIRouter, Response

from app.access.caller import Me, Role
from app.access.roles import READERS, may
from app.context import Here
from app.errors import COMMON
from app.idempotency import Answer, Key, fingerprint, once
from app.regress import jobs as service
from schemas.regression import RegressionList, RegressionRequest, RegressionView

router = APIRouter(prefix="/regressions", tags=["regressions"], responses=COMMON)
RECHECKERS = may(Role.CI, Role.LAB)


@router.post("", dependencies=[RECHECKERS], status_code=202, response_model=RegressionView)
def start_regression(here: Here, me: Me, request: RegressionRequest, key: Key = None) -> Response:
    """Recompute the stored error of every approved set, and fit its runs from scratch: one job per actuator."""

    def started(regression: str) -> Answer:
        view = service.start(here, request, me.name, regression)
        return 202, view.model_dump(), f"/api/v1/regressions/{view.id}"

    return once(here.sessions, key, fingerprint("regression", request.model_dump()), started)


@router.get("", dependencies=[READERS])
def list_regressions(here: Here) -> RegressionList:
    """The newest regressions, without their rechecks."""
    return service.listed(here)


@router.get(
    "/{regression}",
    dependencies=[READERS],
    response_model=RegressionView,
    responses={200: {"content": {"application/xml": {}}}},
)
def get_regression(
    here: Here,
    regression: str,
    format: Literal["json", "junit"] = "json",  # noqa: A002  as of parameter sets
) -> RegressionView | Response:
    """A regression: what moved of each actuator; as JUnit, a test case an actuator, when all have ended."""
    if format == "junit":
        return Response(service.junit(here, regression), media_type="application/xml")
    return service.get(here, regression)

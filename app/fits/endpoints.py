"""/fits: queue a fit, look at it, draw it, approve it."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from app.access.roles import LAB, READERS
from app.access.who import Me
from app.context import Here
from app.errors import COMMON
from app.fits import drawing, export, lineage, service, sizes, starting
from app.idempotency import Answer, Key, fingerprint, once, queued_once
from schemas.fit import (
    ComparisonView,
    EffectsRequest,
    ErrorSizesView,
    FitRequest,
    FitView,
    JobView,
    LadderView,
    SideBySideView,
)
from schemas.parameters import Reason
from schemas.result import ErrorBudget

router = APIRouter(prefix="/fits", tags=["fits"], responses=COMMON)
_MEDIA = ("application/json", "image/svg+xml", "image/png", "application/pdf")
_IMAGES: dict[str, dict[str, str]] = {kind: {} for kind in _MEDIA}
_EXPORTS: dict[str, dict[str, str]] = {media: {} for media in export.MEDIA.values()}
Mass = Annotated[str, Query(max_length=60, description="Mass that the machine moves, such as 2.06 kg")]
Stiffness = Annotated[str, Query(max_length=60, description="Stiffness of its specimen, such as 30.65 kN/m")]
Damping = Annotated[str, Query(max_length=60, description="Damping of its specimen, such as 120 N*s/m")]
Gain = Annotated[str, Query(max_length=60, description="Gain Kp of its loop; without it that of the model, or 1")]
Rate = Annotated[str, Query(max_length=60, description="Samples a second; without it 4096 Hz")]


@router.post("", dependencies=[LAB], status_code=202, response_model=JobView)
def start_fit(here: Here, me: Me, request: FitRequest, key: Key = None) -> Response:
    """Queue a fit, by a search or from where an earlier result ended; Location is its job."""
    asked = fingerprint("fit", request.model_dump())
    return queued_once(here, key, asked, lambda job: starting.submit(here, request, job, me.name))


@router.get("/{fit}", dependencies=[READERS], response_model_exclude_unset=True)
def get_fit(here: Here, fit: str) -> FitView:
    """A fit: the contract's fit JSON in `result`."""
    return service.get(here, fit)


@router.get("/{fit}/compare", dependencies=[READERS])
def compare_fit(here: Here, fit: str) -> ComparisonView:
    """Eq. (17) of every run, recomputed, where the model fails, and what the error is made of."""
    return service.comparison(here, fit)


@router.get("/{fit}/beside", dependencies=[READERS])
def compare_fits(here: Here, fit: str, other: Annotated[list[str], Query(max_length=7)]) -> SideBySideView:
    """The fit and others side by side: errors, parameters, runs; at most eight in all."""
    return service.side_by_side(here, fit, other)


@router.get("/{fit}/error-sizes", dependencies=[READERS])
def get_error_sizes(here: Here, fit: str) -> ErrorSizesView:
    """RMSE and MAE of each run in the unit of its output, beside which eq. (17) is a ratio."""
    return sizes.sizes(here, fit)


@router.get("/{fit}/budget", dependencies=[READERS])
def get_error_budget(here: Here, fit: str) -> ErrorBudget:
    """What the error on the runs to fit is made of: noise, what a linear and what only a nonlinear model could take."""
    return service.budget_of(here, fit)


@router.post("/{fit}/approve", dependencies=[LAB], response_model=FitView)
def approve_fit(here: Here, me: Me, fit: str, reason: Reason | None = None, key: Key = None) -> Response:
    """Make the fit its actuator's current parameter set; who did so, when and why is kept, and older ones stay."""
    why = reason.why if reason else ""

    def approved(_: str) -> Answer:
        return 200, service.approve(here, fit, me.name, why).model_dump(exclude_unset=True), ""

    return once(here.sessions, key, fingerprint("approve", fit, why), approved)


@router.post("/{fit}/withdraw", dependencies=[LAB], response_model=FitView)
def withdraw_fit(here: Here, me: Me, fit: str, reason: Reason | None = None, key: Key = None) -> Response:
    """Take the fit out of force: its actuator has no current set until one is approved. It stays, with its history."""
    why = reason.why if reason else ""

    def withdrawn(_: str) -> Answer:
        return 200, service.withdraw(here, fit, me.name, why).model_dump(exclude_unset=True), ""

    return once(here.sessions, key, fingerprint("withdraw", fit, why), withdrawn)


@router.post("/{fit}/effects", dependencies=[LAB], status_code=202, response_model=JobView)
def add_effects(here: Here, me: Me, fit: str, request: EffectsRequest, key: Key = None) -> Response:
    """Add effects to a fit and fit again with the same settings: a new fit whose parent is this one."""
    asked = fingerprint("effects", fit, request.model_dump())
    return queued_once(here, key, asked, lambda job: lineage.add(here, fit, request, job, me.name))


@router.get("/{fit}/ladder", dependencies=[READERS])
def get_ladder(here: Here, fit: str) -> LadderView:
    """The fits that this one comes from, the first one first; each can still be approved."""
    return lineage.ladder(here, fit)


@router.get(
    "/{fit}/figures/{name}.{kind}",
    dependencies=[READERS],
    response_class=Response,
    responses={200: {"content": _IMAGES}},
)
def draw_fit(here: Here, request: Request, fit: str, name: str, kind: str) -> Response:
    """A figure as json (Vega-Lite), svg, png or pdf; query parameters choose what it shows."""
    query = request.query_params
    options = {key: values if len(values := query.getlist(key)) > 1 else values[0] for key in query}
    content, media = drawing.drawn(here, fit, name, kind, options)
    return Response(content, media_type=media)


@router.get(
    "/{fit}/export.{kind}", dependencies=[READERS], response_class=Response, responses={200: {"content": _EXPORTS}}
)
def export_fit(
    here: Here, fit: str, kind: str, mass: Mass = "", stiffness: Stiffness = "", damping: Damping = "",
    gain: Gain = "", sample_rate: Rate = "",
) -> Response:  # fmt: skip
    """The machine of a fit as h (C header), mat (state space of its linear part) or fmu (FMI 2, co-simulation)."""
    specimen = {"mass": mass, "stiffness": stiffness, "damping": damping}
    content, media, name = export.file(here, fit, kind, specimen, gain, sample_rate)
    return Response(content, media_type=media, headers={"Content-Disposition": f'attachment; filename="{name}"'})

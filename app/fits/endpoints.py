"""/fits: queue a fit, look at it, draw it, approve it."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.context import Here
from app.errors import COMMON
from app.fits import drawing, lineage, service
from app.idempotency import Answer, Key, fingerprint, once, queued_once
from schemas.fit import ComparisonView, EffectsRequest, FitRequest, FitView, JobView, LadderView
from schemas.result import ErrorBudget

router = APIRouter(prefix="/fits", tags=["fits"], responses=COMMON)
_MEDIA = ("application/json", "image/svg+xml", "image/png", "application/pdf")
_IMAGES: dict[str, dict[str, str]] = {kind: {} for kind in _MEDIA}


@router.post("", status_code=202, response_model=JobView)
def submit(here: Here, request: FitRequest, key: Key = None) -> Response:
    """Queue a fit; Location is its job."""
    asked = fingerprint("fit", request.model_dump())
    return queued_once(here, key, asked, lambda job: service.submit(here, request, job))


@router.get("/{fit}", response_model_exclude_unset=True)
def one(here: Here, fit: str) -> FitView:
    """A fit: the contract's fit JSON in `result`."""
    return service.get(here, fit)


@router.get("/{fit}/compare")
def compared(here: Here, fit: str) -> ComparisonView:
    """Eq. (17) of every run, recomputed, where the model fails, and what the error is made of."""
    return service.comparison(here, fit)


@router.get("/{fit}/budget")
def budget(here: Here, fit: str) -> ErrorBudget:
    """What the error on the runs to fit is made of: noise, what a linear and what only a nonlinear model could take."""
    return service.budget_of(here, fit)


@router.post("/{fit}/approve", response_model=FitView)
def approve(here: Here, fit: str, key: Key = None) -> Response:
    """Make the fit its actuator's current parameter set; older ones stay."""

    def approved(_: str) -> Answer:
        return 200, service.approve(here, fit).model_dump(exclude_unset=True), ""

    return once(here.sessions, key, fingerprint("approve", fit), approved)


@router.post("/{fit}/effects", status_code=202, response_model=JobView)
def add_effects(here: Here, fit: str, request: EffectsRequest, key: Key = None) -> Response:
    """Add effects to a fit and fit again with the same settings: a new fit whose parent is this one."""
    asked = fingerprint("effects", fit, request.model_dump())
    return queued_once(here, key, asked, lambda job: lineage.add(here, fit, request, job))


@router.get("/{fit}/ladder")
def ladder(here: Here, fit: str) -> LadderView:
    """The fits that this one comes from, the first one first; each can still be approved."""
    return lineage.ladder(here, fit)


@router.get("/{fit}/figures/{name}.{kind}", response_class=Response, responses={200: {"content": _IMAGES}})
def drawn(here: Here, request: Request, fit: str, name: str, kind: str) -> Response:
    """A figure as json (Vega-Lite), svg, png or pdf; query parameters choose what it shows."""
    query = request.query_params
    options = {key: values if len(values := query.getlist(key)) > 1 else values[0] for key in query}
    content, media = drawing.drawn(here, fit, name, kind, options)
    return Response(content, media_type=media)

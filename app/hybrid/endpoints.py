"""/controllers, /hybrid-simulations, /fits/ID/what-if, /matrices/ID/track: what an identified actuator is good for."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Query, Response

from app.access.roles import LAB, READERS
from app.context import Here
from app.errors import COMMON
from app.hybrid import controllers, drawing, position_loop, service, tracking, what_if
from app.hybrid.request_parsing import request_in
from app.idempotency import Answer, Key, fingerprint, once
from app.jobs.queueing import queued_once
from ident.bench.position_loop import PositionLoop
from ident.hybrid.what_if import WhatIf
from schemas.fit import JobView
from schemas.hybrid import ControllerRequest, HybridRequest, PositionLoopRequest, WhatIfRequest
from schemas.hybrid_result import ControllerPage, ControllerView, HybridPage, HybridView
from schemas.track_result import TrackView

router = APIRouter(tags=["hybrid"], responses=COMMON)
_MEDIA = ("application/json", "image/svg+xml", "image/png", "application/pdf")
_IMAGES: dict[int | str, dict[str, Any]] = {200: {"content": {kind: {} for kind in _MEDIA}}}
_FILES: dict[int | str, dict[str, Any]] = {200: {"content": {kind: {} for kind in controllers.FILES.values()}}}
Limit = Annotated[int, Query(ge=1, le=200)]
Theme = Annotated[str, Query(max_length=20, description="light or dark")]
Share = Annotated[float, Query(ge=0.2, le=4, description="Share of the usual width")]
Run = Annotated[str | None, Query(max_length=200, description="Id of the run; without it the first")]
Part = Annotated[str | None, Query(max_length=200, description="Of several actuators; without it the first")]
Noise = Annotated[
    str | None,
    Query(max_length=60, description="Standard deviation of the sensor (0.12 mm); without it that of the record"),
]
Asked = Annotated[str, Query(max_length=8000, description="The body of POST /fits/ID/what-if, as JSON text")]

AskedLoop = Annotated[str, Query(max_length=4000, description="The body of POST /fits/ID/position-loop, as JSON text")]


@router.post("/controllers", dependencies=[LAB], status_code=201, response_model=ControllerView)
def design_controller(here: Here, request: ControllerRequest, key: Key = None) -> Response:
    """Design a controller for a fit and keep it: it makes the measured displacement follow the wanted one."""

    def answer(made: ControllerView) -> Answer:
        return 201, made.model_dump(exclude_unset=True), f"/api/v1/controllers/{made.id}"

    def find(controller: str) -> Answer | None:
        found = controllers.made_as(here, controller)
        return None if found is None else answer(found)

    asked = fingerprint("controller", request.model_dump())
    return once(
        here.sessions, key, asked, lambda controller: answer(controllers.design(here, request, controller)), find
    )


@router.get("/controllers", dependencies=[READERS], response_model_exclude_unset=True)
def list_controllers(
    here: Here, fit: str | None = None, cursor: str | None = None, limit: Limit = 50
) -> ControllerPage:
    """Controllers, newest first: all, or those of a fit."""
    return controllers.listed(here, fit, cursor, limit)


@router.get("/controllers/{controller}.{kind}", dependencies=[READERS], response_class=Response, responses=_FILES)
def get_controller_file(here: Here, controller: str, kind: str) -> Response:
    """A controller as json (what `servoident control` writes), mat (MATLAB, Octave) or h (a C header)."""
    content, media = controllers.file(here, controller, kind)
    name = f'attachment; filename="controller.{kind}"'
    return Response(content, media_type=media, headers={"Content-Disposition": name})


@router.get("/controllers/{controller}", dependencies=[READERS], response_model_exclude_unset=True)
def get_controller(here: Here, controller: str) -> ControllerView:
    """A controller: the fit and case it is for, margins and robustness."""
    return controllers.get(here, controller)


@router.get(
    "/controllers/{controller}/figures/{name}.{kind}",
    dependencies=[READERS],
    response_class=Response,
    responses=_IMAGES,
)
def draw_controller(
    here: Here, controller: str, name: str, kind: str, theme: Theme = "light", share: Share = 1.0
) -> Response:
    """The figure `closed-loop` of a controller as json (Vega-Lite), svg, png or pdf."""
    content, media = drawing.of_controller(here, controller, name, kind, (theme, share))
    return Response(content, media_type=media)


@router.post("/hybrid-simulations", dependencies=[LAB], status_code=202, response_model=JobView)
def start_hybrid_simulation(here: Here, request: HybridRequest, key: Key = None) -> Response:
    """Queue a hybrid simulation on the machine of a fit; Location is its job."""
    asked = fingerprint("hybrid", request.model_dump())
    return queued_once(here, key, asked, lambda job: service.submit(here, request, job))


@router.get("/hybrid-simulations", dependencies=[READERS])
def list_hybrid_simulations(
    here: Here, fit: str | None = None, cursor: str | None = None, limit: Limit = 50
) -> HybridPage:
    """Hybrid simulations, newest first: all, or those of a fit."""
    return service.listed(here, fit, cursor, limit)


@router.get("/hybrid-simulations/{simulation}", dependencies=[READERS])
def get_hybrid_simulation(here: Here, simulation: str) -> HybridView:
    """A hybrid simulation: whether it is stable, its scores, and the same without a controller."""
    return service.get(here, simulation)


@router.get(
    "/hybrid-simulations/{simulation}/command.csv",
    dependencies=[READERS],
    response_class=Response,
    responses={200: {"content": {"text/csv": {}}}},
)
def get_command_of_table(here: Here, simulation: str) -> Response:
    """The command of a simulated shaking table for its rig: time (s) and command (m), a row a sample."""
    name = {"Content-Disposition": 'attachment; filename="command.csv"'}
    return Response(drawing.command_of_table(here, simulation), media_type="text/csv", headers=name)


@router.get(
    "/hybrid-simulations/{simulation}/figures/{name}.{kind}",
    dependencies=[READERS],
    response_class=Response,
    responses=_IMAGES,
)
def draw_hybrid_simulation(
    here: Here, simulation: str, name: str, kind: str, theme: Theme = "light", share: Share = 1.0, part: Part = None
) -> Response:
    """A figure of a simulation (its `figures` name them) as Vega-Lite, svg, png, pdf."""
    content, media = drawing.of_simulation(here, simulation, name, kind, (theme, share), part)
    return Response(content, media_type=media)


@router.post("/fits/{fit}/what-if", dependencies=[READERS])
def ask_what_if(here: Here, fit: str, request: WhatIfRequest) -> WhatIf:
    """What a change of size, specimen or parameters would do to the machine of a fit. Nothing is stored."""
    return what_if.what_if(here, fit, request)


@router.get(
    "/fits/{fit}/what-if/figures/{name}.{kind}", dependencies=[READERS], response_class=Response, responses=_IMAGES
)
def draw_what_if(
    here: Here, fit: str, name: str, kind: str, asked: Asked = "{}", theme: Theme = "light", share: Share = 1.0
) -> Response:
    """The figures `response` and `root-locus` of a change as json (Vega-Lite), svg, png or pdf."""
    content, media = drawing.of_what_if(here, fit, request_in(asked, WhatIfRequest), name, kind, (theme, share))
    return Response(content, media_type=media)


@router.post("/fits/{fit}/position-loop", dependencies=[READERS])
def ask_position_loop(here: Here, fit: str, request: PositionLoopRequest) -> PositionLoop:
    """The margins of a position loop around the servo-actuator of a fit, at each amplitude. Nothing is stored."""
    return position_loop.position_loop(here, fit, request)


@router.get(
    "/fits/{fit}/position-loop/figures/{name}.{kind}",
    dependencies=[READERS],
    response_class=Response,
    responses=_IMAGES,
)
def draw_position_loop(
    here: Here, fit: str, name: str, kind: str, asked: AskedLoop = "{}", theme: Theme = "light", share: Share = 1.0
) -> Response:
    """The figure `margins` of a position loop as json (Vega-Lite), svg, png or pdf."""
    request = request_in(asked, PositionLoopRequest)
    content, media = drawing.of_position_loop(here, fit, request, name, kind, (theme, share))
    return Response(content, media_type=media)


@router.get("/matrices/{matrix}/track", dependencies=[READERS])
def track_run(here: Here, matrix: str, run: Run = None, noise: Noise = None) -> TrackView:
    """Time constant and gain of a first-order loop over a run, by a Kalman filter, and whether it holds."""
    return tracking.answer(here, matrix, run, noise)


@router.get(
    "/matrices/{matrix}/track/figures/{name}.{kind}", dependencies=[READERS], response_class=Response, responses=_IMAGES
)
def draw_track(
    here: Here,
    matrix: str,
    name: str,
    kind: str,
    run: Run = None,
    noise: Noise = None,
    theme: Theme = "light",
    share: Share = 1.0,
) -> Response:
    """The figure `tracking` of a run as json (Vega-Lite), svg, png or pdf."""
    content, media = drawing.of_track(here, matrix, run, noise, name, kind, (theme, share))
    return Response(content, media_type=media)

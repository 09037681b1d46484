"""What the page that puts a fit to use shows, gathered from the services."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from app.context import Context
from app.errors import Failure, missing
from app.fits import service as fits
from app.hybrid import controllers, position_loop, service, tracking, what_if
from app.jobs import service as jobs
from app.matrices import service as matrices
from app.pages.applications_view import UseView, use_view
from app.pages.control_view import ControlView, control_view
from app.pages.hybrid_view import HybridSection, hybrid_view
from app.pages.job_view import JobPageView, job_page
from app.pages.position_loop_view import PositionLoopView, position_loop_form, position_loop_view
from app.pages.position_loop_view import asked as position_loop_asked
from app.pages.tracking_view import TrackingView, tracking_view
from app.pages.what_if_request import what_if_request
from app.pages.what_if_view import WhatIfView, what_if_form, what_if_view
from ident.errors import Unusable
from ident.hybrid.what_if import WhatIf
from ident.readers.strict_yaml import read_yaml
from ident.words.sentence import sentence
from schemas.hybrid_result import ControllerView as Controller
from schemas.hybrid_result import HybridView as Simulation

Query = Mapping[str, str]
_MOST = 50  # controllers or simulations in a list


def use(context: Context, fit_id: str, query: Query) -> tuple[UseView, int]:
    """The page of a fit with what is asked, and its status: 422 where a section says why it has no answer.

    `query` has `controller` and `simulation`, ids of what is shown instead of the newest, and `ask`, `what-if`,
    `position-loop` or `tracking`, with the fields of its form. Raises Failure 404.
    """
    stored = fits.stored(context, fit_id)
    control = _control(context, fit_id, query.get("controller", ""))
    hybrid = _hybrid(context, stored, query.get("simulation", ""), control)
    changed = _what_if(context, stored, query if query.get("ask") == "what-if" else {})
    tracked = _tracking(context, stored, query if query.get("ask") == "tracking" else {})
    loop = _position_loop(context, stored, query if query.get("ask") == "position-loop" else {})
    refused = changed.problem or tracked.problem or loop.problem
    return use_view(stored, control, hybrid, changed, tracked, loop), 422 if refused else 200


def _control(context: Context, fit: str, wanted: str) -> ControlView:
    found: list[Controller] = controllers.listed(context, fit, None, _MOST).items
    return control_view(found, _chosen(found, wanted, lambda: controllers.get(context, wanted), fit))


def _hybrid(context: Context, stored: fits.Stored, wanted: str, control: ControlView) -> HybridSection:
    found: list[Simulation] = service.listed(context, stored.id, None, _MOST).items
    job = _job(context, stored.id, wanted, {one.id for one in found})
    shown = None if job else _chosen(found, wanted, lambda: service.get(context, wanted), stored.id)
    return hybrid_view(stored.found, found, shown, job, control)


def _job(context: Context, fit: str, wanted: str, made: set[str]) -> JobPageView | None:
    """The job that has not made the simulation which is to be shown. Raises Failure 404."""
    if not wanted or wanted in made:
        return None
    job = jobs.get(context, wanted)
    if job.parent != fit:
        raise missing("hybrid-simulation", wanted)
    return None if job.state == "succeeded" else job_page(job)


def _chosen(found: list[Any], wanted: str, get: Callable[[], Any], fit: str) -> Any:
    """The one of that id, of this fit, else the newest; None where there is none. Raises Failure 404."""
    if not wanted:
        return found[0] if found else None
    one = get()
    if one.fit != fit:
        raise missing("result", wanted)
    return one


def _what_if(context: Context, stored: fits.Stored, given: Query) -> WhatIfView:
    form = what_if_form(stored.found, given)
    if not given:
        return WhatIfView(stored.id, form)
    try:
        request = what_if_request(given)
        return what_if_view(stored, form, request, what_if.what_if(context, stored.id, request))
    except (Unusable, Failure) as error:
        return WhatIfView(stored.id, form, problem=_sentence(error))


def _position_loop(context: Context, stored: fits.Stored, given: Query) -> PositionLoopView:
    if not given:
        return position_loop_form(stored, given)
    try:
        request = position_loop_asked(given)
        return position_loop_view(stored, given, request, position_loop.position_loop(context, stored.id, request))
    except (Unusable, Failure) as error:
        return position_loop_form(stored, given, _sentence(error))


def _tracking(context: Context, stored: fits.Stored, given: Query) -> TrackingView:
    runs = matrices.get(context, stored.matrix).runs
    if not given:
        return tracking_view(stored.matrix, runs, given)
    try:
        run, noise = (given.get(name, "").strip() or None for name in ("run", "noise"))
        return tracking_view(stored.matrix, runs, given, tracking.track(context, stored.matrix, run, noise)[0])
    except (Unusable, Failure) as error:
        return tracking_view(stored.matrix, runs, given, problem=_sentence(error))


def numbers(context: Context, fit_id: str, given: Query) -> WhatIf:
    """All numbers of a what-if, as the API answers it. Raises Failure 404, 422, Unusable."""
    return what_if.what_if(context, fit_id, what_if_request(given))


def read(text: str, where: str) -> Any:
    """A description in YAML as plain data. Raises Unusable."""
    return read_yaml(text.encode(), where)


def _sentence(error: Unusable | Failure) -> str:
    """What, where and remedy."""
    said = f"{error.where}: {error.what}" if error.where else error.what
    return f"{said}. {sentence(error.remedy)}"

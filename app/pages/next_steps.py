"""The next step of every actuator of a list, with a fixed number of queries, and that of one fit."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from app.context import Context
from app.diagnoses import service as diagnoses
from app.fits import service as fits
from app.pages.next_step_view import Next, fit_step, next_step
from app.parameters import service as parameters
from app.parameters.set_query import SetQuery
from schemas.fit import JobView
from schemas.parameters import ActuatorView, ParameterSetView


def next_steps(
    context: Context,
    found: Iterable[ActuatorView],
    newest: Mapping[str, ParameterSetView],
    waiting: Mapping[str, JobView],
) -> dict[str, Next]:
    """What to do next with each of these actuators, by serial number: of its newest fit, or of the job before one."""
    undecided = [one.id for one in newest.values() if not one.current]
    yardsticks, searches = fits.yardsticks(context, undecided), diagnoses.searches(context, undecided)
    steps = {}
    for each in found:
        fit, job = newest.get(each.serial), waiting.get(each.serial)
        known = fit.id if fit else ""
        steps[each.serial] = next_step(each, fit, job, yardsticks.get(known), searches.get(known))
    return steps


def of_fit(context: Context, fit: str) -> Next:
    """What to do next with a fit, in the words of the first page."""
    (stored,) = parameters.page(context, SetQuery(ids=[fit]), None, 1).items
    yardsticks, searches = fits.yardsticks(context, [fit]), diagnoses.searches(context, [fit])
    return fit_step(stored, yardsticks.get(fit), searches.get(fit))

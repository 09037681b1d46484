"""The next step of every actuator of a list, with a fixed number of queries."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from app.context import Context
from app.diagnoses import service as diagnoses
from app.fits import service as fits
from app.pages.next_view import Next, next_step
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

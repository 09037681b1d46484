"""What to do next with an actuator, in a line: from its first fit over what is missing to the set in force."""

from __future__ import annotations

from dataclasses import dataclass
from urllib.parse import quote

from app.diagnoses.service import Search
from app.fits.service import Yardstick
from app.parameters.error import Use, error_of
from ident.diagnosis.result import Verdict
from ident.words.error import ErrorOf
from ident.words.number import plain
from ident.words.sentence import all_of
from ident.words.titles import title
from schemas.fit import JobView
from schemas.parameters import ActuatorView, ParameterSetView

NEAR = 1.1  # times the noise floor: in the residual of a fit as near as that little is to be found


@dataclass(frozen=True)
class Next:
    """Where an actuator stands, and the link that leads on; `waits` is a job whose end changes that.

    `main` marks a step that changes the model. `does` is "diagnose" or "approve" where the fit's own page does it.
    `grade` says whether the fit is good: "good" at the noise floor, "poor" above it or unstable, "" if unknown.
    """

    words: str
    deed: str
    at: str
    waits: str = ""
    main: bool = True
    does: str = ""
    grade: str = ""


def next_step(
    actuator: ActuatorView,
    newest: ParameterSetView | None,
    job: JobView | None,
    yardstick: Yardstick | None = None,
    search: Search | None = None,
) -> Next:
    """The line of an actuator: of a `job` that is to make a fit, else of its set in force, or of its `newest` fit."""
    if job is not None:
        words = "The fit is running." if job.state == "running" else "The fit is queued."
        return Next(words, "Open progress", f"/fits/{job.id}", waits=job.id, main=False)
    if newest is None:
        return Next("Data uploaded, not fitted yet.", "Start a fit", f"/actuators/{quote(actuator.serial)}")
    if actuator.current is not None and not newest.current:
        return _approved(actuator.current, newest, search or Search())
    return fit_step(newest, yardstick, search)


def fit_step(fit: ParameterSetView, yardstick: Yardstick | None = None, search: Search | None = None) -> Next:
    """The next step with a fit; the first page and the page of the fit name the same one."""
    at = f"/fits/{fit.id}"
    if fit.current:
        return Next("Approved. No action needed.", "Open parameters", at, main=False)
    search = search or Search()
    if search.job is not None:
        words = "The search for missing effects is running."
        return Next(words, "Open progress", f"{at}#missing", waits=search.job, main=False)
    said = error_of(fit, "fit")
    if said.is_unstable:
        return Next(f"The model is {said.in_print()}.", "Show where it fails", f"{at}#fails", grade="poor")
    return _fitted(fit, yardstick or Yardstick(), search.verdict, at)


def _approved(current: ParameterSetView, newest: ParameterSetView, search: Search) -> Next:
    """Of an actuator with a set in force, which a fit that came after it does not change: that is only told.

    A fit that was there before the approval has been decided on.
    """
    approved, at = "Approved", f"/fits/{newest.id}"
    if search.job is not None:
        words = f"{approved}. The search for missing effects of a newer fit is running."
        return Next(words, "Open progress", f"{at}#missing", waits=search.job, main=False)
    if current.approved_at and current.approved_at >= newest.created_at:
        return Next(f"{approved}. No action needed.", "Open parameters", f"/fits/{current.id}", main=False)
    before, after = _errors(current, newest)
    if before.error is None or after.error is None:
        words, better = f"{approved}. A newer fit is not approved.", False
    else:
        stands = "but its model is" if before.is_unstable else "with an error of"
        newer = "is" if after.is_unstable else "has"
        words = f"{approved}, {stands} {before.in_print()}. A newer fit {newer} {after.in_print()}."
        better = after.error * NEAR < before.error
    return Next(words, "Compare fits", f"/compare?fits={current.id},{newest.id}", main=better)


def _errors(one: ParameterSetView, other: ParameterSetView) -> tuple[ErrorOf, ErrorOf]:
    """The errors of two sets on runs that no fit saw; on those that were fitted where one has no such runs."""
    use: Use = "fit" if one.error_verify is None or other.error_verify is None else "verify"
    return error_of(one, use), error_of(other, use)


def _fitted(newest: ParameterSetView, yardstick: Yardstick, verdict: Verdict | None, at: str) -> Next:
    """Of a fit that waits for its user."""
    error, before, said = newest.error_fit, yardstick.before, error_of(newest, "fit")
    if error is None or not yardstick.floor:
        words = "Fitted. The noise floor is unknown, so the error cannot be judged."
        return Next(words, "Show where it fails", f"{at}#fails")
    if error > NEAR * yardstick.floor:
        return _failing(error / yardstick.floor, verdict, at)
    if before.error is not None and before.error > NEAR * error:
        fell = "Its model is no longer" if before.is_unstable else "The error fell from"
        to = "; the error is" if before.is_unstable else " to"
        words = f"{fell} {before.in_print()}{to} {said.in_print()}, the noise floor."
        at = f"/compare?fits={yardstick.parent},{newest.id}"
        return Next(words, "Compare before and after", at, grade="good")
    words = f"The error{f', {said.in_print()},' if said.mean_counts else ''} is at the noise floor."
    return Next(words, "Review and approve", at, main=False, does="approve", grade="good")


def _failing(ratio: float, verdict: Verdict | None, at: str) -> Next:
    """Of a fit whose error is so many times the noise."""
    fails = f"The error is {plain(ratio, 2)} times the noise floor"
    if verdict is None:  # the main button at the head of the page does it
        words = f"{fails}: the model is missing an effect."
        return Next(words, "Search for missing effects", at, does="diagnose", grade="poor")
    at = f"{at}#missing"
    if verdict.effects:
        sure = verdict.standing in (None, "found")
        said = "The model lacks" if sure else "The error is partly explained by"
        return Next(f"{fails}. {said} {all_of([*map(title, verdict.effects)])}.", "Review and add", at, grade="poor")
    if verdict.suspects:
        return Next(f"{fails}. A run label looks wrong.", "Review the label", at, grade="poor")
    return Next(f"{fails}. No effect in the library explains it.", "Show the residual", at, grade="poor")

"""What to do next with an actuator follows from where it stands."""

from __future__ import annotations

from typing import Any

import pytest

from app.diagnoses.service import Search
from app.fits.service import Yardstick
from app.pages.next_step_view import Next, fit_step, next_step
from ident.diagnosis.result import Suspect, Verdict
from ident.words.error import ErrorOf
from schemas.fit import JobView, ProgressView
from schemas.parameters import ActuatorView, ParameterSetView

NOISE = 0.005


def step(error: float | None = None, *, state: str = "", current: bool = False, **known: Any) -> Next:
    """The line of an actuator with a fit of this error, or whose job is in this state; `known` is about the fit."""
    actuator = ActuatorView(
        serial="S/1 ä", name="", batch="", piston_area=None, created_at="", matrices=1, fits=1, current=None
    )
    job = JobView(
        id="j",
        kind="fit",
        state=state,
        matrix="m",
        serial=actuator.serial,
        settings={},
        progress=ProgressView(),
        parent=None,
        fit=None,
        diagnosis=None,
        problem=None,
        created_at="",
        ended_at=None,
    )
    fit = ParameterSetView(
        id="f",
        serial=actuator.serial,
        batch="",
        model="qian2014",
        created_at="",
        approved_at=None,
        current=current,
        error_fit=error,
        error_verify=error,
        parameters={},
    )
    return next_step(actuator, None if error is None else fit, job if state else None, **known)


def verdict(*effects: str, suspects: int = 0) -> Search:
    """A search that found these effects and so many doubted labels."""
    return Search(verdict=Verdict(effects=effects, suspects=(Suspect("r"),) * suspects, unexplained=True))


MISSING = "/fits/f#missing"
COMPARED = "/compare?fits=c,f"
FAR = Yardstick(floor=NOISE)
FELL = Yardstick(parent="p", before=ErrorOf(0.12), floor=NOISE)


@pytest.mark.parametrize(
    ("found", "words", "deed", "at"),
    [
        (step(), "not fitted yet", "Start a fit", "/actuators/S/1%20%C3%A4"),
        (step(state="queued"), "is queued", "Open progress", "/fits/j"),
        (step(0.1, state="running"), "fit is running", "Open progress", "/fits/j"),
        (step(0.1, yardstick=FAR), "20 times the noise floor", "Search for missing effects", "/fits/f"),
        (step(0.1, yardstick=FAR, search=Search(job="d")), "is running", "Open progress", MISSING),
        (step(0.1, yardstick=FAR, search=verdict("lead", "lag")), "lacks lead and lag.", "Review and add", MISSING),
        (step(0.1, yardstick=FAR, search=verdict(suspects=1)), "A run label looks wrong", "Review the label", MISSING),
        (step(0.1, yardstick=FAR, search=verdict()), "No effect in the library", "Show the residual", MISSING),
        (step(0.1, yardstick=FELL), "20 times the noise floor", "Search for missing effects", "/fits/f"),
        (step(NOISE, yardstick=FELL), "from 12.0 % to 0.500 %", "Compare before and after", "/compare?fits=p,f"),
        (step(NOISE, yardstick=FAR), "at the noise floor", "Review and approve", "/fits/f"),
        (step(NOISE), "cannot be judged", "Show where it fails", "/fits/f#fails"),
        (step(0.1, current=True, yardstick=FAR), "No action needed", "Open parameters", "/fits/f"),
    ],
)
def test_the_line_says_where_it_stands_and_leads_on(found, words, deed, at):
    """From no fit over what is missing to the set in force, one link a state."""
    assert words in found.words
    assert (found.deed, found.at) == (deed, at)


@pytest.mark.parametrize(
    ("found", "grade"),
    [
        (step(NOISE, yardstick=FAR), "good"),
        (step(NOISE, yardstick=FELL), "good"),
        (step(0.1, yardstick=FAR), "poor"),
        (step(0.1, yardstick=FAR, search=verdict("lead")), "poor"),
        (step(0.1), ""),
        (step(state="queued"), ""),
    ],
)
def test_a_fit_is_good_at_the_noise_floor_and_poor_above_it(found, grade):
    """Without a floor nothing is known of it."""
    assert found.grade == grade


def test_a_line_that_a_job_will_change_names_it():
    """So that the page can be drawn anew when that job ends."""
    waiting = [step(state="queued"), step(0.1, search=Search(job="d")), step(0.1, yardstick=FAR)]
    assert [each.waits for each in waiting] == ["j", "d", ""]


def approved(newer: float, *, verify: float | None = None, before: bool = False, **known: Any) -> Next:
    """The line of an actuator whose approved set is at the noise, and which was fitted `before` that or since."""
    made = ParameterSetView(
        id="c", serial="S", batch="", model="qian2014", created_at="2026-01-01", approved_at="2026-01-03", current=True,
        error_fit=NOISE, error_verify=None if verify is None else NOISE, parameters={},
    )  # fmt: skip
    fit = made.model_copy(update={
        "id": "f", "created_at": "2026-01-02" if before else "2026-01-04", "approved_at": None, "current": False,
        "error_fit": newer, "error_verify": verify,
    })  # fmt: skip
    actuator = ActuatorView(
        serial="S", name="", batch="", piston_area=None, created_at="", matrices=1, fits=2, current=made
    )
    return next_step(actuator, fit, None, **known)


@pytest.mark.parametrize(
    ("found", "words", "deed", "at", "main"),
    [
        (approved(0.044, yardstick=FAR), "error of 0.500 %. A newer fit has 4.40 %", "Compare fits", COMPARED, False),
        (approved(0.044, yardstick=FAR, search=verdict("lead")), "fit has 4.40 %", "Compare fits", COMPARED, False),
        (approved(0.003, yardstick=FAR), "A newer fit has 0.300 %.", "Compare fits", COMPARED, True),
        (approved(0.003, verify=0.02), "A newer fit has 2.00 %.", "Compare fits", COMPARED, False),
        (approved(0.044, before=True, yardstick=FAR), "No action needed", "Open parameters", "/fits/c", False),
        (approved(0.044, search=Search(job="d")), "of a newer fit is running", "Open progress", MISSING, False),
    ],
)
def test_an_approved_actuator_is_judged_by_its_approved_set(found, words, deed, at, main):
    """A fit that came after it, better or worse, is told as one; another one that was there already is not."""
    assert found.words.startswith("Approved")
    assert words in found.words
    assert "times the noise floor" not in found.words
    assert (found.deed, found.at, found.main) == (deed, at, main)


def test_the_line_says_an_unstable_run_by_name_and_the_mean_where_it_counts():
    """Of the fit before, of the set in force and of the newer fit; an error that fell from a huge number is none."""
    fell = Yardstick(parent="p", before=ErrorOf(12.0, unstable=["k24"]), floor=NOISE)
    assert step(NOISE, yardstick=fell).words == (
        "Its model is no longer unstable on run k24; the error is 0.500 %, the noise floor."
    )
    fit = ParameterSetView(
        id="f",
        serial="S",
        batch="",
        model="qian2014",
        created_at="2026-01-04",
        approved_at=None,
        current=False,
        error_fit=NOISE,
        error_verify=12.0,
        parameters={},
        error_with_mean_fit=45.0,
        unstable_verify=["k24"],
    )
    assert fit_step(fit, FAR).words == "The error, 0.500 % (with the mean 45.0 times), is at the noise floor."
    made = fit.model_copy(update={"id": "c", "approved_at": "2026-01-03", "current": True})
    actuator = ActuatorView(
        serial="S", name="", batch="", piston_area=None, created_at="", matrices=1, fits=2, current=made
    )
    assert next_step(actuator, fit, None).words == (
        "Approved, but its model is unstable on run k24. A newer fit is unstable on run k24."
    )

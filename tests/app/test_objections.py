"""A fit far above its noise floor, or contradicted by verify runs, is approved with a reason only."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import pytest
from fastapi.testclient import TestClient

from app.fits.objections import FAR, Errors, objections
from app.tables import ActuatorRow, DiagnosisRow, FitRow, MatrixRow, SetRow
from ident.unstable import UNSTABLE
from ident.words.error import ErrorOf

API = "/api/v1"
FLOOR = {"fit": 0.005, "verify": 0.006}
UNKNOWN = {"fit": None, "verify": None}


@pytest.mark.parametrize(
    ("fit", "verify", "floor", "said"),
    [
        (FAR * 0.005, FAR * 0.006, FLOOR, []),
        (FAR * 0.00501, 0.006, FLOOR, ["the error is 0.751 %, 1.5 times the noise floor of 0.500 %"]),
        (0.12, None, FLOOR, ["the error is 12.0 %, 24 times the noise floor of 0.500 %"]),
        (0.005, 0.06, FLOOR, ["the error on validation data is 6.00 %, 10 times their noise floor of 0.600 %"]),
        (
            0.02,
            0.05,
            UNKNOWN,
            ["the error on validation data is 5.00 %, 2.5 times the error on estimation data of 2.00 %"],
        ),
        (0.02, 0.02, UNKNOWN, []),
        (None, None, {}, []),
        (ErrorOf(12.0, unstable=["k24"]), None, FLOOR, ["the error is unknown: the model is unstable on run k24"]),
        (UNSTABLE, None, FLOOR, ["the error is unknown: the model is unstable"]),
        (
            ErrorOf(0.12, 0.9),
            None,
            FLOOR,
            ["the error is 12.0 % (with the mean 90.0 %), 24 times the noise floor of 0.500 %"],
        ),
    ],
)
def test_what_speaks_against_an_approval_follows_from_errors_and_floors(
    fit: float | ErrorOf | None, verify: float | None, floor: dict[str, float | None], said: list[str]
) -> None:
    """At 1.5 times the floor nothing does, above it the first clause; verify runs have a floor of their own."""
    error = fit if isinstance(fit, ErrorOf) else ErrorOf(fit)
    assert list(objections({"fit": error, "verify": ErrorOf(verify)}, floor, (), ())) == said


def test_an_effect_that_verify_runs_contradict_speaks_against_the_fit_that_has_it() -> None:
    """Another effect that they contradict does not."""
    sound: Errors = {"fit": ErrorOf(0.005), "verify": ErrorOf(0.006)}
    assert objections(sound, FLOOR, ("lead",), ("dead_zone",)) == ()
    assert objections(sound, FLOOR, ("lead", "dead_zone"), ("dead_zone",)) == (
        "with dead zone the error on validation data rises",
    )


def stored(
    service: TestClient, like: str, name: str, error: float, effects: Sequence[str] = (), parent: str | None = None
) -> str:
    """A fit like another of this service, with this error at a floor of 0.5 %, of an actuator of its own."""
    summary: dict[str, Any] = {"data_hash": "", "runs": [], "findings": [], "notices": []}
    result = service.get(f"{API}/fits/{like}").json()["result"]
    errors = {"error": {"fit": error, "verify": error}, "noise_floor": {"fit": 0.005, "verify": 0.005}}
    with service.app.state.context.sessions.begin() as session:  # type: ignore[attr-defined]
        session.add(ActuatorRow(serial=name, batch="OBJECT"))
        session.flush()
        session.add(MatrixRow(id=f"m-{name}", serial=name, batch="OBJECT", source={}, summary=summary))
        session.flush()
        row = FitRow(
            id=f"o-{name}",
            matrix=f"m-{name}",
            serial=name,
            model="qian2014",
            parent=parent,
            result=result | errors | {"effects": list(effects)},
        )
        row.set = SetRow(serial=name, batch="OBJECT", model="qian2014", error_fit=error, error_verify=error)
        session.add(row)
    return row.id


def main_deeds(page: str) -> list[str]:
    """The texts of the main buttons at the head of a page."""
    head = page.partition('<div class="deeds whole">')[2].partition('<div class="columns')[0]
    return re.findall(r'<(?:button|a)[^>]*class="(?:button )?main"[^>]*>([^<]*)<', head)


def test_a_fit_far_above_its_noise_is_approved_with_a_reason_only(service: TestClient, fitted: str) -> None:
    """Over HTTP it is refused with what is wrong and the remedy, and the reason is kept with who gave it."""
    fit = stored(service, fitted, "OBJECT-1", 0.12)
    for body in (None, {"why": ""}, {"why": "  \t"}):
        refused = service.post(f"{API}/fits/{fit}/approve", json=body)
        assert refused.status_code == 422
        problem = refused.json()
        assert problem["code"] == "reason-needed"
        assert problem["detail"].startswith("the error is 12.0 %, 24 times the noise floor")
        assert "reason" in problem["remedy"]
    assert service.get(f"{API}/actuators/OBJECT-1").json()["current"] is None
    assert "; ".join(service.get(f"{API}/fits/{fit}").json()["objections"]) == problem["detail"]
    page = service.get(f"/fits/{fit}").text
    assert "An approval needs a reason" in page
    assert "24 times the noise floor" in page
    accepted = service.post(f"{API}/fits/{fit}/approve", json={"why": "the customer wants the linear model"})
    assert accepted.json()["current"]
    (kept, *_) = service.get(f"{API}/actuators/OBJECT-1").json()["approvals"]
    assert kept["why"] == "the customer wants the linear model"


def test_a_sound_fit_needs_no_reason_unless_a_diagnosis_contradicts_it(service: TestClient, fitted: str) -> None:
    """The diagnosis is that of the fit before it, which saw the error rise on verify runs."""
    assert service.post(f"{API}/fits/{stored(service, fitted, 'OBJECT-2', 0.005)}/approve").json()["current"]
    before = stored(service, fitted, "OBJECT-3", 0.02)
    verdict = {"effects": ["lead"], "standing": "contradicted", "contradicted_by": ["lead"]}
    with service.app.state.context.sessions.begin() as session:  # type: ignore[attr-defined]
        session.add(
            DiagnosisRow(
                id="d-OBJECT-3", matrix="m-OBJECT-3", serial="OBJECT-3", fit=before, result={"verdict": verdict}
            )
        )
    after = stored(service, fitted, "OBJECT-4", 0.005, ["lead"], before)
    refused = service.post(f"{API}/fits/{after}/approve")
    assert refused.json()["detail"] == "with lead the error on validation data rises"


def test_the_main_button_of_a_fit_is_the_next_step_of_the_first_page(service: TestClient, fitted: str) -> None:
    """Approving is the main button where nothing but noise is left; else the button does what the first page names."""
    far, sound = (stored(service, fitted, f"OBJECT-{n}", error) for n, error in ((5, 0.12), (6, 0.005)))
    first = service.get("/?q=OBJECT-5").text
    assert "24 times the noise floor" in first
    assert "Search for missing effects</a>" in first
    poor, good = (service.get(f"/fits/{fit}").text for fit in (far, sound))
    assert main_deeds(poor) == ["Search for missing effects"]
    assert main_deeds(good) == ["Approve for OBJECT-6"]
    assert [text for text in ("Not good yet", "Conditional on the model", "Good fit") if text in poor] == [
        "Not good yet",
        "Conditional on the model",
    ]
    assert [text for text in ("Not good yet", "Conditional on the model", "Good fit") if text in good] == ["Good fit"]

"""/fits/…/approve and withdraw: which set is in force for an actuator."""

from __future__ import annotations

from fastapi import APIRouter, Response

from app.access.caller import Me
from app.access.roles import LAB
from app.approvals import service
from app.context import Here
from app.errors import COMMON
from app.idempotency import Answer, Key, fingerprint, once
from schemas.fit import FitView
from schemas.parameters import Reason

router = APIRouter(prefix="/fits", tags=["fits"], responses=COMMON)


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

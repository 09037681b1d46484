"""What webhooks are sent, for the OpenAPI document: calls that a receiver answers, none of the service's own."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Header

from schemas.webhooks import JobEnded, LimitBroken, SetApproved, SetWithdrawn

told = APIRouter(tags=["webhooks"], generate_unique_id_function=lambda route: route.name)
Id = Annotated[str, Header(alias="X-Servoident-Delivery", description="The same at every try, as in the body")]
At = Annotated[int, Header(alias="X-Servoident-Timestamp", description="Of this try, s since 1970")]
Signed = Annotated[
    str,
    Header(alias="X-Servoident-Signature", description="sha256= and the HMAC-SHA256 of TIMESTAMP.BODY, hexadecimal"),
]


@told.post("job.ended", status_code=204)
def told_job_ended(body: JobEnded, delivery: Id, timestamp: At, signature: Signed) -> None:
    """A job has ended."""


@told.post("set.approved", status_code=204)
def told_set_approved(body: SetApproved, delivery: Id, timestamp: At, signature: Signed) -> None:
    """A parameter set is in force from now on."""


@told.post("set.withdrawn", status_code=204)
def told_set_withdrawn(body: SetWithdrawn, delivery: Id, timestamp: At, signature: Signed) -> None:
    """A parameter set is in force no longer."""


@told.post("limit.broken", status_code=204)
def told_limit_broken(body: LimitBroken, delivery: Id, timestamp: At, signature: Signed) -> None:
    """A set in force breaks a limit for sure."""

"""Webhooks: who is told of what, and what they are sent."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from schemas.fit import JobProblem

EventName = Literal["job.ended", "set.approved", "set.withdrawn", "limit.broken"]
EVENTS: tuple[EventName, ...] = ("job.ended", "set.approved", "set.withdrawn", "limit.broken")


class WebhookRequest(BaseModel):
    """An address that is to be told of events: all of them, unless some are named."""

    model_config = ConfigDict(extra="forbid")
    url: str = Field(max_length=2000)
    events: Annotated[list[EventName], Field(min_length=1, max_length=10)] = list(EVENTS)


class WebhookView(BaseModel):
    """A webhook without its secret. `waiting` counts what has not reached it yet; `problem` is why, if it is known."""

    id: str
    url: str
    events: list[EventName]
    who: str
    created_at: str
    revoked_at: str | None
    waiting: int
    problem: str


class NewWebhook(WebhookView):
    """A webhook that was just made. What it is sent is signed with `secret`: said once, null to a repeated request."""

    secret: str | None


class WebhookPage(BaseModel):
    """A page of webhooks, oldest first."""

    items: list[WebhookView]
    next: str | None = None


class DeliveryView(BaseModel):
    """An event on its way to a webhook: `state` is waiting, delivered, given up (after 24 h) or dropped (revoked).

    `status` is the last answer's, null where there was none; `problem` says what was wrong with it.
    """

    id: str
    webhook: str
    url: str
    event: EventName
    state: Literal["waiting", "delivered", "given up", "dropped"]
    tries: int
    status: int | None
    problem: str
    created_at: str
    next_at: str | None
    ended_at: str | None


class DeliveryPage(BaseModel):
    """A page of deliveries, newest first."""

    items: list[DeliveryView]
    next: str | None = None


class Event(BaseModel):
    """What every body has: the id of the delivery, the same at every try; and when the event was."""

    id: str
    at: str


class EndedJob(BaseModel):
    """A job that succeeded, failed or was cancelled. What it made has its id."""

    id: str
    kind: str
    state: str
    serial: str
    matrix: str
    parent: str | None
    problem: JobProblem | None


class JobEnded(Event):
    """A job has ended."""

    event: Literal["job.ended"] = "job.ended"
    job: EndedJob


class SetApproved(Event):
    """A parameter set is in force for an actuator from now on."""

    event: Literal["set.approved"] = "set.approved"
    serial: str
    fit: str
    who: str
    why: str


class SetWithdrawn(Event):
    """A parameter set is in force no longer, and no other is."""

    event: Literal["set.withdrawn"] = "set.withdrawn"
    serial: str
    fit: str
    who: str
    why: str


class LimitBroken(Event):
    """A set in force breaks a limit for sure: it was approved, or the limits were changed."""

    event: Literal["limit.broken"] = "limit.broken"
    serial: str
    fit: str
    model: str
    batch: str
    broken: list[str]
    reasons: list[str]

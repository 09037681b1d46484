"""Rechecks of approved actuators: does today's program still find what was approved?"""

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

Outcome = Literal["same", "moved", "failed", "open"]
State = Literal["running", "passed", "failed"]


class RegressionRequest(BaseModel):
    """Which sets in force to recheck, all where nothing is given; `tolerance` is the largest relative change."""

    model_config = ConfigDict(extra="forbid")
    serial: str | None = None
    batch: str | None = None
    model: str | None = None
    tolerance: Annotated[float, Field(ge=0, allow_inf_nan=False)] = 1e-3


class ChangeView(BaseModel):
    """A quantity before and now; `after` is null where there is none any more, `relative` where it moved from 0.

    Its `kind` says whether it is an error, eq. (17), or the value of a parameter.
    """

    quantity: str
    before: float
    after: float | None
    std_error: float | None
    relative: float | None
    moved: bool
    kind: Literal["error", "parameter"] = "parameter"


class RecheckView(BaseModel):
    """What became of one actuator: the quantities that moved, and the largest relative change."""

    serial: str
    fit: str
    job: str
    outcome: Outcome
    failure: str
    seconds: float | None
    moved: list[ChangeView]
    largest: ChangeView | None


class RegressionView(BaseModel):
    """A regression: `running` until every actuator is rechecked, then `passed`, or `failed` where one differs."""

    id: str
    state: State
    asked: dict[str, Any]
    tolerance: float
    who: str
    created_at: str
    counts: dict[Outcome, int]
    rechecks: list[RecheckView] = []


class RegressionList(BaseModel):
    """Regressions, the newest first, without their rechecks."""

    items: list[RegressionView]

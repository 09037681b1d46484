"""What parameters have to keep to, and whether an actuator does."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

Finite = Annotated[float, Field(strict=True, allow_inf_nan=False)]


class Limit(BaseModel):
    """Lower and upper limit of a parameter, either of which may be left out, in `unit`."""

    model_config = ConfigDict(extra="forbid")
    lower: Finite | None = None
    upper: Finite | None = None
    unit: str = Field(max_length=60)


class LimitsRequest(BaseModel):
    """All limits of a model: by parameter, or `error.fit` and `error.verify`; for one batch, or, without one, for all.

    A quantity of the acceptance sheet is `sheet.` and its name. They take the place of those before.
    """

    model_config = ConfigDict(extra="forbid")
    batch: str = Field(default="", max_length=200)
    limits: dict[str, Limit] = Field(max_length=200)


class LimitView(Limit):
    """A limit as it was given, with what it is in SI, who set it and when."""

    si_lower: float | None
    si_upper: float | None
    si_unit: str
    who: str
    changed_at: str


class BatchLimits(BaseModel):
    """The limits of a batch; those of "" hold in every batch that has no other for the same parameter."""

    batch: str
    limits: dict[str, LimitView]


class LimitsView(BaseModel):
    """The limits of a model."""

    model: str
    batches: list[BatchLimits]


class JudgedView(BaseModel):
    """One value against its limits, SI: `uncertain` where it lies within two standard errors of one of them."""

    name: str
    value: float | None
    std_error: float | None
    unit: str
    lower: float | None
    upper: float | None
    outcome: Literal["inside", "outside", "unknown"]
    uncertain: bool
    reason: str


class SheetLine(BaseModel):
    """A quantity of the acceptance sheet, SI; `outcome` and `reason` are null where it has no limit."""

    name: str
    meaning: str
    value: float | None
    std_error: float | None
    unit: str
    lower: float | None
    upper: float | None
    outcome: Literal["inside", "outside", "unknown"] | None
    reason: str | None


class SheetView(BaseModel):
    """The acceptance sheet of a fit of bench records, against the limits by which its actuator is judged."""

    fit: str
    serial: str
    model: str
    batch: str
    verdict: Literal["pass", "fail", "unknown"] | None
    lines: list[SheetLine]


class LineVerdictView(BaseModel):
    """Whether an actuator's set in force keeps to the limits of its model: `fail` where a value lies outside for sure.

    `unknown` where one is uncertain, or cannot be judged; the reasons say which and why.
    """

    serial: str
    verdict: Literal["pass", "fail", "unknown"]
    reasons: list[str]
    fit: str | None
    model: str | None
    batch: str
    approved_at: str | None
    judged: list[JudgedView]

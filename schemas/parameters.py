"""Parameter sets, as the production line asks for them."""

from pydantic import BaseModel, ConfigDict, Field


class ValueView(BaseModel):
    """One parameter's value."""

    value: float
    unit: str
    std_error: float | None


class LineageView(BaseModel):
    """Where a set comes from: the hash of its data, the effects of its model, the seed of its search, the program.

    `equations` is a hash of the model's equations; earlier versions did not keep it, nor `who` asked for the fit.
    """

    data_hash: str
    effects: list[str]
    seed: int | None
    version: str
    equations: str
    who: str


class ParameterSetView(BaseModel):
    """A parameter set of an actuator; `current` is the approved one in force, `approved_at` when it was last made so.

    The batch is that of the matrix from which it was identified. `error_fit` and `error_verify` are eq. (17), which a
    difference of means does not change; with the mean counted they are RMS(x − x_m)/std(x_m), null where an earlier
    version did not keep it. `unstable_fit` and `unstable_verify` are the runs on which the model is unstable: the
    error over them is no number then.
    """

    id: str
    serial: str
    batch: str
    model: str
    created_at: str
    approved_at: str | None
    current: bool
    error_fit: float | None
    error_verify: float | None
    error_with_mean_fit: float | None = None
    error_with_mean_verify: float | None = None
    unstable_fit: list[str] = []
    unstable_verify: list[str] = []
    parameters: dict[str, ValueView]
    lineage: LineageView | None = None


class ParameterSetPage(BaseModel):
    """A page of parameter sets, newest first."""

    items: list[ParameterSetView]
    next: str | None = None


class ActuatorView(BaseModel):
    """An actuator and its approved parameter set."""

    serial: str
    name: str
    batch: str
    piston_area: float | None
    created_at: str
    matrices: int
    fits: int
    current: ParameterSetView | None


class ActuatorPage(BaseModel):
    """A page of actuators by serial number."""

    items: list[ActuatorView]
    next: str | None = None


class ApprovalView(BaseModel):
    """From when until when a fit was in force for the actuator; without a fit, what was before it was withdrawn."""

    model_config = ConfigDict(populate_by_name=True)
    fit: str | None
    since: str = Field(serialization_alias="from", validation_alias="from")
    until: str | None = Field(serialization_alias="to", validation_alias="to")
    who: str
    why: str


class ActuatorDetail(ActuatorView):
    """One actuator with its history: every set and matrix, and who approved what, the newest first."""

    sets: list[ParameterSetView]
    matrix_ids: list[str]
    approvals: list[ApprovalView] = []


class Reason(BaseModel):
    """Why an approval is given or withdrawn."""

    model_config = ConfigDict(extra="forbid")
    why: str = Field(default="", max_length=2000)

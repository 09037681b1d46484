"""Parameter sets, as the production line asks for them."""

from pydantic import BaseModel


class ValueView(BaseModel):
    """One parameter's value."""

    value: float
    unit: str
    std_error: float | None


class ParameterSetView(BaseModel):
    """A parameter set of an actuator; `current` is the approved one in force."""

    id: str
    serial: str
    batch: str
    model: str
    created_at: str
    approved_at: str | None
    current: bool
    error_fit: float | None
    error_verify: float | None
    parameters: dict[str, ValueView]


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


class ActuatorDetail(ActuatorView):
    """One actuator with its history."""

    sets: list[ParameterSetView]
    matrix_ids: list[str]

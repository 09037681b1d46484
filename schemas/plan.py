"""Test plans for a rig, as they are asked for and as they are sent."""

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

from ident.planning.law import Law
from ident.planning.planned_run import RefusedRun
from ident.planning.signal import Signal
from schemas.fit import Finite
from schemas.result import ActuatorStated, RigStated

Short = Annotated[str, Field(max_length=200)]
Value = Finite | Short
Program = Annotated[Short | dict[str, Any], Field(examples=["qian", "kononykhin"])]
"""`qian`, `kononykhin`, or an object with what the YAML file of a program holds."""


class PlanRequest(BaseModel):
    """A plan: the program, the stored fit that predicts the peaks, the limits of the rig with their units.

    Without `rig` the limits are those of the matrix that the fit was made of. `seconds` is the length of a run, `ramp`
    the time in which a command grows and that in which it fades. Every parameter may be off by the share `spread`
    (20 %), those in `spreads` by their own. `least` is the smallest share of its amplitude to which a run is scaled.
    """

    model_config = ConfigDict(extra="forbid")
    program: Program
    fit: str | None = None
    rig: dict[str, Short] | None = Field(default=None, max_length=6)
    seconds: Value | None = None
    ramp: Value | None = None
    spread: Value | None = None
    spreads: dict[str, Value] = Field(default_factory=dict, max_length=50)
    least: float = Field(default=0.1, gt=0, le=1)
    seed: int = Field(default=0, ge=0, lt=2**31)


class MovedView(BaseModel):
    """What the actuator moves, SI."""

    mass: float
    stiffness: float
    damping: float


class PlannedRunView(BaseModel):
    """A run: `size` is its amplitude and `asked` that of the program, `scale` the one over the other.

    `share` is what it takes of the tightest limit, `limit`; null where nothing is judged.
    """

    id: str
    kind: str
    use: str
    asked: float
    size: float
    scale: float
    words: str
    signal: Signal | None = None
    law: Law | None = None
    specimen: MovedView | None = None
    gain: float | None = None
    limit: str = ""
    share: float | None = None
    peaks: dict[str, float] = Field(default_factory=dict)


class PlanView(BaseModel):
    """A plan: limits and peaks in SI; `sentences` say in words what it is judged by and what was scaled."""

    id: str
    fit: str | None
    created_at: str
    program: str
    model: str
    spread: str
    actuator: ActuatorStated
    limits: RigStated
    runs: list[PlannedRunView]
    refused: list[RefusedRun]
    unjudged: list[str]
    notes: list[str]
    median_share: float | None
    sentences: list[str]


class PlanPage(BaseModel):
    """Plans, newest first."""

    items: list[PlanView]
    next: str | None = None

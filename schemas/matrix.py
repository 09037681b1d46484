"""Matrices: what was uploaded, what was found in it, and how to mend its labels."""

from typing import Any

from pydantic import BaseModel, ConfigDict, Field


class FindingView(BaseModel):
    """One doubt about a matrix, in words; `key` and `values` are its message as data, absent in older findings."""

    run: str | None
    severity: str
    code: str
    text: str
    key: str = ""
    values: dict[str, Any] = {}


class RunView(BaseModel):
    """One run: conditions in SI; `units` are the SI units of its channels.

    `time_unit` is "sample" where the sample period is unknown: the rate is then 1/sample, the duration in samples.
    """

    id: str
    use: str
    kind: str
    hold: str
    output: str
    samples: int
    sample_rate: float
    duration: float
    gain: float | None
    amplitude: float | None
    mass: float | None
    stiffness: float | None
    damping: float | None
    channels: list[str]
    units: dict[str, str] = Field(default_factory=lambda: {"command": "m", "displacement": "m"})
    time_unit: str = "s"


class MatrixView(BaseModel):
    """A stored matrix; batch and area are what it states of its actuator.

    `states_oil` is whether what it states of its actuator are parts of a machine with oil: area, volume, supply
    pressure or servo-valve. `machine` is the model that its description puts together from stages, where it does. Raw
    runs that the rule removed are gone since `removed_at`.
    """

    id: str
    serial: str
    parent: str | None
    created_at: str
    batch: str = ""
    piston_area: float | None = None
    states_oil: bool = False
    data_hash: str
    runs: list[RunView]
    findings: list[FindingView]
    notices: list[str]
    machine: str = ""
    removed_at: str | None = None


class MatrixPage(BaseModel):
    """A page of matrices; `next` is the cursor of the page that follows."""

    items: list[MatrixView]
    next: str | None = None


class Revision(BaseModel):
    """Labels, units and signs to change; raw bytes stay.

    `actuator` and each entry of `runs` (by run id) are merged into the description; null takes a field away.
    """

    model_config = ConfigDict(extra="forbid")
    actuator: dict[str, Any] = Field(default_factory=dict)
    runs: dict[str, dict[str, Any]] = Field(default_factory=dict)

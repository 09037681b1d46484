"""Diagnoses: what is missing from a fitted model."""

from typing import Any

from pydantic import BaseModel, ConfigDict, Field

from schemas.fit import Chosen


class DiagnosisRequest(Chosen):
    """A diagnosis to be queued: of a stored `fit`, or of a `matrix`, whose fit with these settings is made first.

    The effects that `custom` defines are ranked beside those of the catalogue.
    """

    fit: str | None = None
    matrix: str | None = None
    max_effects: int | None = Field(default=None, ge=0)


class CandidateView(BaseModel):
    """An effect that the model lacks, best first by held-out error; `group` are those it cannot be told from."""

    model_config = ConfigDict(extra="allow")
    effect: str
    error: dict[str, float | None]
    predicted_error: float
    parameters: dict[str, dict[str, Any]]
    group: list[str]
    evidence: dict[str, Any]
    why: str


class RungView(BaseModel):
    """A step of the ladder: what was added to the model before it, null for the fitted model itself.

    `nats` by which it made the held-out data more likely.
    """

    model_config = ConfigDict(extra="allow")
    added: str | None
    error: dict[str, float | None]
    parameters: dict[str, dict[str, Any]]
    nats: float | None = None


class VerdictView(BaseModel):
    """What to add, what the data cannot tell apart, whose label is doubted, whether something is left."""

    model_config = ConfigDict(extra="allow")
    effects: list[str]
    indistinguishable: list[list[str]]
    suspects: list[dict[str, Any]]
    unexplained: bool
    text: str


class DiagnosisView(BaseModel):
    """A stored diagnosis, and the fit that it is about."""

    model_config = ConfigDict(extra="allow")
    id: str
    matrix: str
    serial: str
    fit: str
    created_at: str
    model: str
    baseline: dict[str, Any]
    noise_floor: dict[str, float | None]
    budget: dict[str, Any]
    candidates: list[CandidateView]
    ladder: list[RungView]
    verdict: VerdictView
    next_experiment: dict[str, Any]
    seconds: float


class DiagnosisPage(BaseModel):
    """A page of diagnoses, newest first."""

    items: list[DiagnosisView]
    next: str | None = None


class ProposalView(BaseModel):
    """The run that the lab should add, SI: `text` says why, `conditions` what, `run` is its entry in matrix.yaml.

    `separation` are the standard deviations of the noise by which the models in question will then differ, `so_far`
    those by the runs there are; `std_errors` the share of each standard error that is expected to be left.
    """

    model_config = ConfigDict(extra="allow")
    text: str
    conditions: str
    signal: str
    amplitude: float
    unit: str
    frequency: float
    seconds: float
    sample_rate: float
    seed: int
    gain: float | None
    specimen: dict[str, float] | None
    separation: float | None
    so_far: float | None
    information: float
    std_errors: dict[str, float]
    run: dict[str, Any]

"""Diagnoses: what is missing from a fitted model."""

from pydantic import BaseModel, Field

from schemas.diagnosis_result import DiagnosisResult
from schemas.fit import Chosen


class DiagnosisRequest(Chosen):
    """A diagnosis to be queued: of a stored `fit`, or of a `matrix`, whose fit with these settings is made first.

    `bounds` and `set` may be of parameters of effects that may be added, and with a `fit` are of these alone. The
    effects that `custom` defines or names are ranked beside those of the catalogue; with `own` all that the lab keeps
    and the model can take. After `time` seconds nothing more is tried: what was found by then is the diagnosis. Terms
    that no list holds are searched for where the catalogue does not explain the residual; with `propose` true also
    where nobody knows the noise, with false never.
    """

    fit: str | None = None
    matrix: str | None = None
    max_effects: int | None = Field(default=None, ge=0)
    time: float | None = Field(default=None, gt=0)
    own: bool = False
    propose: bool | None = None


class DiagnosisView(DiagnosisResult):
    """A stored diagnosis, and the fit that it is about."""

    id: str
    matrix: str
    serial: str
    fit: str
    created_at: str


class DiagnosisPage(BaseModel):
    """A page of diagnoses, newest first."""

    items: list[DiagnosisView]
    next: str | None = None

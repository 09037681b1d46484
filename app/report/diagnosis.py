"""A diagnosis as it was written to JSON: what the report shows of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pydantic import BaseModel, Field, ValidationError

from ident.errors import Unusable
from ident.words.titles import title

Errors = dict[str, float | None]


class Candidate(BaseModel):
    """One effect that was tried."""

    effect: str
    error: Errors = Field(default_factory=dict)
    predicted_error: float | None = None
    parameters: dict[str, Any] = Field(default_factory=dict)
    group: list[str] | str | int | None = None
    why: str = ""


class Step(BaseModel):
    """One effect that was added; `added` is empty for the fitted model."""

    added: str | list[str] | None = None
    error: Errors = Field(default_factory=dict)
    parameters: dict[str, Any] = Field(default_factory=dict)


class Verdict(BaseModel):
    """What is missing, in words and in names."""

    effects: list[str] = Field(default_factory=list)
    indistinguishable: list[list[str]] = Field(default_factory=list)
    suspects: list[dict[str, Any]] = Field(default_factory=list)
    unexplained: bool = False
    text: str = ""


class Diagnosis(BaseModel):
    """The contract's diagnose JSON, as far as a report shows it."""

    baseline: dict[str, Any] = Field(default_factory=dict)
    noise_floor: float | Errors | None = None
    candidates: list[Candidate]
    ladder: list[Step]
    verdict: Verdict

    @property
    def floor(self) -> float | None:
        """The noise floor of the runs to fit."""
        return self.noise_floor.get("fit") if isinstance(self.noise_floor, dict) else self.noise_floor

    @property
    def steps(self) -> list[tuple[str, float | None, float | None]]:
        """The ladder as the figure takes it, the fitted model first."""
        first = self.baseline.get("error")
        rows = [(_added(step), step.error.get("fit"), step.error.get("verify")) for step in self.ladder]
        if isinstance(first, dict) and not (self.ladder and not self.ladder[0].added):
            rows.insert(0, ("as fitted", first.get("fit"), first.get("verify")))
        return rows


def _added(step: Step) -> str:
    names = [step.added] if isinstance(step.added, str) else step.added or []
    return " + ".join(map(title, names)) or "as fitted"


def read_diagnosis(path: Path) -> Diagnosis:
    """A diagnosis from its JSON file; raises Unusable where it is not one."""
    try:
        return Diagnosis.model_validate_json(path.read_bytes())
    except ValidationError:
        raise Unusable(
            "bad-diagnosis", "not the JSON of a diagnosis", str(path), "give what `servoident diagnose --json` wrote"
        ) from None

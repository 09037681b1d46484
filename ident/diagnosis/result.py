"""What a diagnosis found, in the contract's words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ident.diagnosis.suspects import Suspect

Errors = Mapping[str, float | None]
"""Eq. (17) averaged over the runs of a kind: fit, held_out, verify; None where there are none."""


@dataclass(frozen=True)
class Found:
    """One parameter of a refit, SI, with its standard error (None where the data do not determine it)."""

    value: float
    unit: str
    std_error: float | None
    symbol: str = ""

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data."""
        return {"value": self.value, "unit": self.unit, "std_error": self.std_error, "symbol": self.symbol}


@dataclass(frozen=True)
class Ranked:
    """An effect that the model lacks: what it was predicted to gain, what its refit gained, and why.

    `group` are the effects that the data cannot tell from it. `confirmed` is False where only the prediction was made.
    """

    effect: str
    error: Errors
    offset: float | None
    predicted_error: float
    parameters: Mapping[str, Found]
    group: tuple[str, ...]
    evidence: Mapping[str, float | str | bool | None]
    why: str

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data."""
        return {
            "effect": self.effect, "error": dict(self.error), "offset": self.offset,
            "predicted_error": self.predicted_error, "parameters": {n: p.to_json() for n, p in self.parameters.items()},
            "group": list(self.group), "evidence": dict(self.evidence), "why": self.why,
        }  # fmt: skip


@dataclass(frozen=True)
class Rung:
    """A step of the ladder: what was added (None: the fitted model), the errors after it, the parameters.

    `nats` tell by how much the step made the held-out data more likely.
    """

    added: str | None
    error: Errors
    offset: float
    parameters: Mapping[str, Found]
    nats: float | None

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data."""
        return {
            "added": self.added, "error": dict(self.error), "offset": self.offset, "nats": self.nats,
            "parameters": {n: p.to_json() for n, p in self.parameters.items()},
        }  # fmt: skip


@dataclass(frozen=True)
class Verdict:
    """What to add, what the data cannot tell apart, whose label is doubted, and whether something is left."""

    effects: tuple[str, ...]
    indistinguishable: tuple[tuple[str, ...], ...]
    suspects: tuple[Suspect, ...]
    unexplained: bool
    text: str

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data."""
        return {
            "effects": list(self.effects), "indistinguishable": [list(group) for group in self.indistinguishable],
            "suspects": [suspect.to_json() for suspect in self.suspects], "unexplained": self.unexplained,
            "text": self.text,
        }  # fmt: skip


@dataclass(frozen=True)
class Diagnosis:
    """Everything that was found about one fit of one matrix."""

    model: str
    given: tuple[str, ...]
    baseline: Mapping[str, Any]
    noise_floor: Errors
    candidates: tuple[Ranked, ...]
    ladder: tuple[Rung, ...]
    verdict: Verdict
    seed: int
    version: str
    data_hash: str
    seconds: float = 0.0
    budget: Mapping[str, Any] = field(default_factory=dict)
    next_experiment: Mapping[str, Any] = field(default_factory=dict)
    settings: Mapping[str, Any] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data (no NaN, no infinity)."""
        return {
            "model": self.model, "effects": list(self.given), "baseline": dict(self.baseline),
            "noise_floor": dict(self.noise_floor), "budget": dict(self.budget),
            "candidates": [candidate.to_json() for candidate in self.candidates],
            "ladder": [rung.to_json() for rung in self.ladder], "verdict": self.verdict.to_json(),
            "next_experiment": dict(self.next_experiment), "settings": dict(self.settings), "seed": self.seed,
            "seconds": self.seconds, "version": self.version, "data_hash": self.data_hash, "notes": list(self.notes),
        }  # fmt: skip

"""How sure a diagnosis was, as it is kept with a trial: its probabilities, and the gains from which they follow."""

from __future__ import annotations

from typing import Any

from ident.diagnosis.result import Diagnosis


def sure(found: Diagnosis) -> dict[str, Any]:
    """The probability of the verdict, of each name, every set of effects that was refitted, and each step's error."""
    verdict = found.verdict
    return {
        "probability": verdict.probability,
        "probabilities": {name: float(f"{p:.4g}") for name, p in verdict.probabilities.items()},
        "effect_sets": [[list(one.effects), float(f"{one.nats:.5g}")] for one in found.effect_sets],
        "most_nats": found.most_nats,
        "steps": [[rung.added, rung.error.get("fit")] for rung in found.ladder],
    }

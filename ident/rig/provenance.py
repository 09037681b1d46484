"""Who measured, when, for whom and at which oil temperature: what a data sheet states of a test."""

from __future__ import annotations

from dataclasses import dataclass, fields


@dataclass(frozen=True)
class Provenance:
    """What is stated of a test, as text for people; `oil_temperature` is in K. What is not stated is empty or None."""

    laboratory: str = ""
    customer: str = ""
    order: str = ""
    operator: str = ""
    date: str = ""
    oil_temperature: float | None = None

    def over(self, other: Provenance) -> Provenance:
        """What this states, and of the rest what the other states."""
        return Provenance(**{of.name: getattr(self, of.name) or getattr(other, of.name) for of in fields(Provenance)})


UNSTATED = Provenance()
TEXTS = ("laboratory", "customer", "order", "operator", "date")
"""Those of its fields that are lines of text."""

"""Who measured, when, for whom, and how warm and old the oil was: what a data sheet states of a test."""

from __future__ import annotations

from dataclasses import dataclass, fields


@dataclass(frozen=True)
class Provenance:
    """What is stated of a test, as text for people. What is not stated is empty or None.

    `oil_temperature` is in K, `oil_age` the time for which the oil was used, in s, `cycles` the load cycles of the
    machine before the test.
    """

    laboratory: str = ""
    customer: str = ""
    order: str = ""
    operator: str = ""
    date: str = ""
    oil_temperature: float | None = None
    oil_age: float | None = None
    cycles: float | None = None

    def over(self, other: Provenance) -> Provenance:
        """What this states, and of the rest what the other states."""
        own = {of.name: getattr(self, of.name) for of in fields(Provenance)}
        return Provenance(
            **{name: getattr(other, name) if value in ("", None) else value for name, value in own.items()}
        )


UNSTATED = Provenance()
TEXTS = ("laboratory", "customer", "order", "operator", "date")
"""Those of its fields that are lines of text."""

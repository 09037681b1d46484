"""Who measured, when, for whom and at which oil temperature: what a data sheet states of a test."""

from __future__ import annotations

from dataclasses import dataclass, fields


@dataclass(frozen=True)
class TestRecord:
    """What is stated of a test, as text for people; `oil_temperature` is in K. What is not stated is empty or None."""

    laboratory: str = ""
    customer: str = ""
    order: str = ""
    operator: str = ""
    date: str = ""
    oil_temperature: float | None = None

    __test__ = False  # to pytest it looks like a class of tests

    def over(self, other: TestRecord) -> TestRecord:
        """What this states, and of the rest what the other states."""
        return TestRecord(**{of.name: getattr(self, of.name) or getattr(other, of.name) for of in fields(TestRecord)})


UNSTATED = TestRecord()
TEXTS = ("laboratory", "customer", "order", "operator", "date")
"""Those of its fields that are lines of text."""

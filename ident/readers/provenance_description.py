"""The block `test` of a description, or what is stated in its place: who measured, when, and in which condition."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import date
from typing import Any

from ident.errors import Unusable
from ident.readers.typed_fields import Fields
from ident.rig.provenance import TEXTS, Provenance
from ident.units.quantity import shown


def describe_test(data: Mapping[str, Any], where: str = "test") -> Provenance:
    """Raises Unusable for a key that there is not, a date that is none, a temperature without a unit."""
    fields = Fields(data, where, (*TEXTS, "oil_temperature", "oil_age", "cycles"))
    day = fields.text("date")
    if day:
        try:
            date.fromisoformat(day)
        except ValueError:
            what = f"{shown(day)!r} is not a date"
            raise Unusable("not-a-date", what, fields.place("date"), "write year, month, day: 2026-03-31") from None
    return Provenance(
        **{name: fields.text(name) for name in TEXTS},
        oil_temperature=fields.positive("oil_temperature", "temperature"),
        oil_age=fields.not_negative("oil_age", "time"),
        cycles=fields.not_negative("cycles", "dimensionless"),
    )

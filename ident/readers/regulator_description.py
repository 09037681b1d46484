"""The block `regulator` of a description: the position loop in which an actuator of a bench is to work."""

from __future__ import annotations

from typing import Any

from ident.errors import Unusable
from ident.readers.typed_fields import Fields
from ident.rig.regulator import REGULATOR_UNITS, PositionControl, Regulator
from ident.units.quantity import parameter_value, shown


def describe_regulator(data: Any, where: str = "regulator") -> PositionControl:
    """Raises Unusable for a key that there is not, a value of another unit, or one that is no regulator's."""
    fields = Fields(data, where, (*REGULATOR_UNITS, "amplitudes"))
    fields.need("kp", "give kp in rated currents a length, such as 8 %/mm")
    values = {name: fields.number(name, unit) for name, unit in REGULATOR_UNITS.items()}
    given = data.get("amplitudes") or []
    if not isinstance(given, list):
        raise Unusable("not-a-list", f"{shown(given)!r} is not a list", fields.place("amplitudes"), "write [2 %, 10 %]")
    amplitudes = tuple(parameter_value(one, "1", fields.place("amplitudes")) for one in given)
    if any(one <= 0 for one in amplitudes):
        raise Unusable("bad-amplitude", "an amplitude is not above 0", fields.place("amplitudes"), "write [2 %, 10 %]")
    return PositionControl(Regulator(**{name: one for name, one in values.items() if one is not None}), amplitudes)

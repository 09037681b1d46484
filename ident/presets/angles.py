"""A setting of a parameter in the unit in which a machine that turns, or of unknown period, shows it."""

from __future__ import annotations

from contextlib import suppress

from ident.errors import Unusable
from ident.presets.record_units import SAMPLE, RecordUnits
from ident.units.quantity import parameter_value

_SHOWN = tuple(
    RecordUnits(turning=turning, clock=clock, pressed=pressed)
    for pressed in (False, True)
    for clock in ("s", SAMPLE)
    for turning in (False, True)
)


def in_si(text: str | float, unit: str, where: str) -> float:
    """A setting of a parameter in SI: in its `unit`, or in one that it is shown in.

    Raises Unusable as :func:`ident.units.quantity.parameter_value`, of the first.
    """
    try:
        return parameter_value(text, unit, where)
    except Unusable:
        for shown in _SHOWN:
            with suppress(Unusable):
                return parameter_value(text, shown.shown(unit), where)
        raise

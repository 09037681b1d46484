"""A machine that turns: its lengths, forces and masses are shown as angles, torques and inertias."""

from __future__ import annotations

import re
from collections.abc import Iterable
from contextlib import suppress

from ident.errors import Unusable
from ident.matrix import Run
from ident.parameter import Parameter
from ident.units.quantity import parameter_value

_TURNING = {"m": "rad", "N": "N*m", "kg": "kg*m^2"}
_RECORDED = ("rad", "rad/s", "N*m")


def in_angles(parameters: Iterable[Parameter], runs: Iterable[Run]) -> bool:
    """Whether a turning motion was recorded, of a machine without oil.

    Where a pressure acts it turns by a volume a radian, of which nothing is stated.
    """
    turning = any(run.units.get(run.output) in _RECORDED for run in runs)
    return turning and not any("Pa" in parameter.unit for parameter in parameters)


def unit_shown(unit: str, drive: str | None, turning: bool) -> str:
    """A unit of the chain as it is shown: a metre as the `drive` signal's where it is one of that, else as an angle."""
    names = dict(_TURNING) if turning else {}
    if drive is not None:
        names["m"] = drive
    return re.sub(r"\b(kg|N|m)\b", lambda found: names.get(found[0], found[0]), unit)


def in_si(text: str | float, unit: str, where: str) -> float:
    """A setting of a parameter in SI: in its `unit`, or in the one that it is shown in where it turns.

    Raises Unusable as :func:`ident.units.quantity.parameter_value`, of the first.
    """
    try:
        return parameter_value(text, unit, where)
    except Unusable:
        with suppress(Unusable):
            return parameter_value(text, unit_shown(unit, None, turning=True), where)
        raise

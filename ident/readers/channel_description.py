"""One channel of a run: where its samples are and how they become SI."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ident.errors import Unusable
from ident.readers.typed_fields import Fields
from ident.run import CHANNELS, DISTURBANCES
from ident.units.quantity import DIMENSIONS, Scale, parameter_value, shown, split, unit_scale

PRESSURE, WAY, SPEED, FORCE = ("pressure",), ("length", "angle"), ("velocity", "angular velocity"), ("force", "torque")
ACCELERATION = "acceleration"
_NO_COMMAND = ("dimensionless", "per sample", ACCELERATION)
KINDS_OF_UNIT: dict[str, Sequence[str]] = {
    "command": (ACCELERATION, *(name for name in DIMENSIONS if name not in _NO_COMMAND)),
    "displacement": WAY, "velocity": SPEED, "acceleration": (ACCELERATION,),
    "force": (*FORCE, *PRESSURE), "drive_force": FORCE, "load_pressure": PRESSURE,
    "pressure_a": PRESSURE, "pressure_b": PRESSURE, "supply_pressure": PRESSURE, "vertical_load": ("force",),
    "flow_disturbance": ("flow",), "load_disturbance": FORCE, "sensor_disturbance": WAY,
    "spool": ("length", "voltage", "current"), "current": ("current", "voltage"), "temperature": ("temperature",),
}  # fmt: skip
"""What each channel may be measured in; ``1`` is allowed everywhere, for records in unknown units. A force that is
measured as a pressure is a stress, the force for each area of a specimen. ``g`` is the standard gravity of a command,
and no gram."""
_LISTED = 4  # kinds of unit that a message names


@dataclass(frozen=True)
class ChannelDescription:
    """SI value = ``scale.factor`` × raw + ``scale.offset``; `column` is a name or a 0-based number.

    `zeroed`: whether the transducer's zero was set by hand for the run, None where nobody said.
    """

    column: str | int
    scale: Scale
    zeroed: bool | None = None


def describe_channels(data: Any, where: str, around: Sequence[str] = ()) -> dict[str, ChannelDescription]:
    """Every channel of a run by name; `around` are the keys of the run."""
    fields = Fields(data, where, CHANNELS, around)
    return {name: describe_channel(fields.data[name], name, f"{where}.{name}") for name in fields.data}


def describe_disturbance(data: Any, where: str) -> dict[str, ChannelDescription]:
    """What acts beside the command: a channel, and the place where it adds, by the channel's name."""
    fields = Fields(data, where, ("place", "column", "unit", "scale", "offset", "invert"))
    fields.need("place", f"say where it adds: {', '.join(DISTURBANCES.values())}")
    place = fields.choice("place", tuple(DISTURBANCES.values()), "")
    name = next(channel for channel, at in DISTURBANCES.items() if at == place)
    return {name: describe_channel({key: fields.data[key] for key in fields.data if key != "place"}, name, where)}


def describe_channel(data: Any, name: str, where: str) -> ChannelDescription:
    """One channel: ``unit × (scale × raw + offset)``, with ``invert`` of the opposite sign.

    `scale` is a number (column units a raw unit), `offset` a number in the channel's unit or a quantity.
    """
    fields = Fields(data, where, ("column", "unit", "scale", "offset", "invert", "zeroed"))
    column = fields.need("column", "name its column, or give the 0-based number")
    if isinstance(column, list | dict) or (isinstance(column, int) and column < 0):
        raise Unusable("missing-column", f"{shown(column)!r} is not a column", fields.place("column"), "write a name")
    if "unit" not in fields:
        usual = "mm" if "length" in KINDS_OF_UNIT[name] else DIMENSIONS[KINDS_OF_UNIT[name][0]]
        remedy = f"add unit: {usual}"
        raise Unusable("missing-unit", "the channel has no unit", fields.place("unit"), remedy)
    scale = channel_scale(fields.text("unit"), name, fields.place("unit"))
    factor = fields.number("scale")
    if factor == 0:
        raise Unusable("zero-scale", "scale is 0, which erases the samples", fields.place("scale"), "correct it")
    offset = channel_offset(fields, scale)
    sign = -1.0 if fields.truth("invert") else 1.0
    total = sign * scale.factor * (1.0 if factor is None else factor)
    zeroed = fields.truth("zeroed") if "zeroed" in fields else None
    return ChannelDescription(column, Scale(total, sign * (scale.offset + offset), scale.unit), zeroed)


def channel_scale(unit: str, name: str, where: str) -> Scale:
    """How a unit of any kind that the channel may have becomes SI.

    Raises Unusable: ``unknown-unit``, ``wrong-dimension``.
    """
    allowed = (*KINDS_OF_UNIT[name], "dimensionless")
    if unit in ("C", "F") and "temperature" in allowed:
        allowed = ("temperature",)  # of no other kind are these
    for dimension in allowed:
        try:
            return unit_scale(unit, dimension, where)
        except Unusable as refused:
            if refused.code != "wrong-dimension":
                raise
    kinds = KINDS_OF_UNIT[name]
    wanted = " or ".join(kinds) if len(kinds) <= _LISTED else "a quantity that is known here"
    remedy = f"give a unit of {wanted}, or 1 where it is unknown"
    raise Unusable("wrong-dimension", f"{shown(unit)!r} does not measure {wanted}", where, remedy)


def channel_offset(fields: Fields, scale: Scale) -> float:
    """The offset in SI: a bare number counts in the channel's unit, as its scale does."""
    if "offset" not in fields:
        return 0.0
    text, place = fields.data["offset"], fields.place("offset")
    number, given = split(text, place)
    return parameter_value(text, scale.unit, place) if given else number * scale.factor

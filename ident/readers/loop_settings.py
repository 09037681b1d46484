"""The gain of a position loop and a sample rate, as matrix.yaml and the case of a hybrid simulation write them."""

from __future__ import annotations

from ident.errors import Unusable
from ident.readers.typed_fields import Fields
from ident.units.quantity import known_powers, parameter_value, quantity, shape, shown, split

GAIN_UNIT = "V/m"
"""Of the gain of a loop whose output is a voltage; the gain of any other loop is a number."""

_SAMPLES = ("S", "Sa", "sample", "samples")
"""What a second is divided into, as acquisition programs write it; S alone is no unit elsewhere."""


def loop_gain(fields: Fields, key: str = "gain") -> float | None:
    """Kp, a number, or a voltage over a length in V/m; None where it is not given.

    Raises Unusable: ``not-a-quantity``, ``unknown-unit``, ``wrong-dimension``.
    """
    if key not in fields:
        return None
    value, place = fields.data[key], fields.place(key)
    unit = split(value, place)[1] or "1"
    kind = shape(known_powers(unit, place), place)
    for dimension in ("1", GAIN_UNIT):
        if kind == shape(known_powers(dimension, place), place):
            return parameter_value(value, dimension, place)
    what = f"{unit!r} is neither a number nor a voltage over a length"
    raise Unusable("wrong-dimension", what, place, f"write 7, or 160 {GAIN_UNIT} for a loop whose output is a voltage")


def sample_rate(fields: Fields, key: str = "sample_rate") -> float | None:
    """Samples a second, Hz: `4096 Hz` or `4096 samples/s`; None where it is not given.

    Raises Unusable: as :func:`ident.units.quantity.quantity`, and ``not-positive``.
    """
    if key not in fields:
        return None
    text, place = fields.data[key], fields.place(key)
    unit = split(text, place)[1].replace(" ", "")
    if unit.endswith("/s") and unit[:-2] in _SAMPLES:
        text = f"{split(text, place)[0]!r} Hz"
    rate = quantity(text, "frequency", place)
    if rate <= 0:
        remedy = "give the number of samples a second"
        raise Unusable("not-positive", f"{shown(fields.data[key])} is not above 0", place, remedy)
    return rate


def seconds_or_samples(fields: Fields, key: str, time_unit: str) -> float | None:
    """A time of 0 or more in s, or in samples where the clock is unknown; None where it is not given.

    Raises Unusable: ``negative-KEY`` and what reading a quantity does.
    """
    if key not in fields:
        return None
    if time_unit == "s":
        return fields.not_negative(key, "time")
    return float(fields.whole(key))

"""The units of nearly every matrix, worked out: reading these does without pint, whose import takes most of a second.

A test holds each against pint, which stays the arbiter of every other name.
"""

from __future__ import annotations

from collections.abc import Mapping

_WEIGHT = {"[mass]": 1.0, "[length]": 1.0, "[time]": -2.0}
_PRESSURE = {"[mass]": 1.0, "[length]": -1.0, "[time]": -2.0}
_VOLTAGE = {"[mass]": 1.0, "[length]": 2.0, "[time]": -3.0, "[current]": -1.0}
_KINDS: tuple[tuple[Mapping[str, float], Mapping[str, float]], ...] = (
    ({"[length]": 1.0}, {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "µm": 1e-6, "inch": 0.0254, "in": 0.0254}),
    ({"[mass]": 1.0}, {"kg": 1.0, "g": 1e-3, "t": 1e3}),
    ({"[time]": 1.0}, {"s": 1.0, "ms": 1e-3, "µs": 1e-6, "min": 60.0}),
    ({"[time]": -1.0}, {"Hz": 1.0, "kHz": 1e3, "rpm": 0.10471975511965977}),
    ({"[sample]": 1.0}, {"sample": 1.0}),
    ({"[current]": 1.0}, {"A": 1.0, "mA": 1e-3}),
    ({"[temperature]": 1.0}, {"K": 1.0}),
    (_WEIGHT, {"N": 1.0, "kN": 1e3}),
    (_PRESSURE, {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "bar": 1e5, "psi": 6894.757293168362}),
    (_VOLTAGE, {"V": 1.0, "mV": 1e-3}),
    ({}, {"percent": 0.01, "rad": 1.0, "deg": 0.017453292519943295}),
)

USUAL = {name: (factor, tuple(powers.items())) for powers, names in _KINDS for name, factor in names.items()}
"""Each name with its factor to SI and the powers of its dimensions."""

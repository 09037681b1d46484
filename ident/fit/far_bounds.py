"""Bounds and values of a user that lie far from where a machine has the parameter: a unit that was meant otherwise."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from ident.fit.criteria import FIT_CRITERIA
from ident.fit.parameter_bounds import of_model
from ident.fit.settings import Settings
from ident.fit.space import search_space
from ident.matrix import Matrix
from ident.presets import Preset
from ident.units.quantity import si_scale
from ident.words.message import Message, message

Range = tuple[float, float]
FAR = FIT_CRITERIA.ranges.far
_MEANT = {
    "s": {"ms": "milliseconds", "us": "microseconds"},
    "m": {"mm": "millimetres", "um": "micrometres", "in": "inches", "cm": "centimetres"},
    "N": {"kN": "kilonewtons"},
    "Pa": {"MPa": "megapascals", "bar": "bar", "kPa": "kilopascals"},
    "kg": {"g": "grams", "t": "tonnes"},
    "1": {"%": "per cent"},
    "N/m": {"kN/m": "kilonewtons a metre", "N/mm": "newtons a millimetre"},
}
"""By SI unit, the units in which a number may have been meant, the likeliest first, and in words."""


def far_bounds(settings: Settings, preset: Preset, matrix: Matrix, band: float) -> Iterator[Message]:
    """What was given far from the ranges that are searched where nothing is given, as causes of a bad fit.

    `band` is the angular frequency up to which the command excites the machine, rad/s.
    """
    if not (settings.bounds or settings.fixed):
        return
    space = search_space(preset, matrix, replace(settings, bounds={}, fixed={}), band)
    middle = space.values(np.full((1, len(space.axes)), 0.5))
    yield from far_from(settings, preset, space.bounds({name: float(value[0]) for name, value in middle.items()}))


def far_from(settings: Settings, preset: Preset, ranges: Mapping[str, Range]) -> Iterator[Message]:
    """The same, beside known `ranges` by the equations' names; where there is none a parameter's own bounds hold."""
    settings = of_model(settings, preset)
    given: dict[str, Range] = {**settings.bounds, **{name: (value, value) for name, value in settings.fixed.items()}}
    for name, stated in given.items():
        parameter = preset.parameter(name)
        own = ranges.get(parameter.in_equations, (parameter.lower, parameter.upper))
        ratio = _size(stated) / _size(own) if _size(own) else 1.0
        if not (ratio >= FAR or 0.0 < ratio <= 1.0 / FAR) or _overlap(stated, own):
            continue
        remedy = _remedy(stated, own, parameter.unit)
        large = ratio > 1.0
        times = _rounded(ratio if large else 1.0 / ratio)
        values = {"name": name, "given": _told(stated, parameter.unit), "times": times, "remedy": remedy}
        if name in settings.bounds:
            yield message("cause.bounds_large" if large else "cause.bounds_small", **values)
        else:
            yield message("cause.value_large" if large else "cause.value_small", **values)


def _size(of: Range) -> float:
    """The middle of a range of one sign on a logarithmic scale; of one that reaches zero its farther end."""
    lower, upper = of
    return float(np.sqrt(lower * upper)) if lower * upper > 0 else max(abs(lower), abs(upper))


def _overlap(one: Range, other: Range) -> bool:
    """Whether ranges of one sign have values in common; what reaches zero is judged by its size alone."""
    of_one_sign = one[0] * one[1] > 0 and other[0] * other[1] > 0
    return of_one_sign and one[0] <= other[1] and other[0] <= one[1]


def _rounded(ratio: float) -> str:
    """A ratio in two digits, without an exponent."""
    return f"{float(f'{ratio:.2g}'):.15g}"


def _told(of: Range, unit: str, sign: str = " to ") -> str:
    shown = "" if unit == "1" else f" {unit}"
    return sign.join(f"{end:g}{shown}" for end in dict.fromkeys(of))


def _remedy(stated: Range, own: Range, unit: str) -> Message:
    """The unit in which the numbers are of this machine's size, if there is one."""
    for meant, words in _MEANT.get(unit, {}).items():
        factor = si_scale(meant, "bounds").factor
        ratio = factor * _size(stated) / _size(own)
        if 1.0 / FAR < ratio < FAR:
            return message("cause.write", value=_told(stated, meant, ":"), unit=words)
    return message("cause.searched", range=_told(own, unit))

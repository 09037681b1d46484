"""How an effect's parameters are searched on a machine of any size."""

from __future__ import annotations

import re
from collections.abc import Mapping

from ident.effects.effect import Effect
from ident.parameter import Parameter, Starts
from ident.stages import Scale

_OWN = ("1", None)
_SCALES = {
    "1": _OWN,
    "Pa": _OWN,
    "m/s": _OWN,
    "s": ("T", 3.0),
    "1/s": ("W", 1.0),
    "m": ("Z", 1.0),
    "1/m": ("1/D", 3.0),
    "s/m": ("T/D", 5.0),
    "N": ("F", 1.0),
    "N/m^3": ("F/L**3", 0.3),
    "m/Pa": ("D*A/F", 1.0),
    "1/Pa": ("A/F", 1.0),
    "s/m^3": ("1/(A*V)", 1.0),
    "1/m^2": ("1/L**2", 1.0),
    "m^3/(s*Pa^0.5)": ("A*V/sqrt(F/A)", 1.0),
    "m/N": ("L/F", 1.0),
    "m^3/(s*Pa)": ("A*V/(F/A)", 1.0),
    "N/m": ("F/L", 1e2),
}
"""For a machine of unknown size: what a strength of each unit is measured by, and how much of it is searched.

D and F stand for the sizes of its drive signal and its forces, Z for the widest zone that lets some of the drive signal
through, T for the time of an answer; L and V, as W, are typical of the runs: the deviations of motion and speed.
`_OWN`: within its own bounds.
"""

_OF_MOTION = {
    "m": ("L", 2.0),
    "1/m": ("1/L", 2.0),
    "m/s": ("V", 1.0),
    "s/m": ("1/V", 2.0),
    "N": ("F*(1 + 1/L)", 2.0),
}
"""The same of what belongs to the motion, which would else be measured by the drive signal, or by its own bounds.

A way of up to two deviations of the motion: a specimen may yield, or a spring begin to act, at the end of a sine only.
A weight that the drive lifts through L radians has the torque F/L of an arm held level, or F where it turns farther.
"""
_RINGING = 4.0
"""Times the highest frequency that the commands excite, up to which a part of the machine may ring: what is held, or
straight between the samples, has little power there, and a light damping needs little.
Test: tests/diagnosis/test_hanging_mass.py"""

_RELAXING = 30.0
"""Times the longest time of an answer, up to which a part may relax: what creeps is slower than what moves it.
Test: tests/diagnosis/test_relaxation.py"""
_FARTHER = {Starts.RESONANCE: _RINGING, Starts.RELAXATION: _RELAXING}


def _measured_by(unit: str) -> tuple[str, float | None]:
    """The measure of a strength of this unit; a force for each power of the speed or the way, and a flow for each power
    of the pressure, by its power."""
    if unit in _SCALES:
        return _SCALES[unit]
    if of_speed := re.fullmatch(r"N\*s\^(\d)/m\^\1", unit):
        return f"F/V**{of_speed[1]}", 10.0
    if of_way := re.fullmatch(r"N/m\^(\d)", unit):
        return f"F/L**{of_way[1]}", 1.0
    if of_pressure := re.fullmatch(r"m\^3/\(s\*Pa\^([\d.]+)\)", unit):
        return f"A*V/(F/A)**{of_pressure[1]}", 1.0
    return _OWN


def scale_of(effect: Effect, parameter: Parameter, sizes: Mapping[str, str]) -> Scale:
    """How to search an effect's parameter for a machine of another size than its bounds were stated for.

    A user's effect states its own bounds, which hold. So they do where the model has no force.
    """
    text, reach = _measured_by(parameter.unit)
    if reach is not None:
        reach *= _FARTHER.get(parameter.start, 1.0)
    if parameter.of_motion:
        text, reach = _OF_MOTION[parameter.unit]
    logarithmic = parameter.searched and parameter.logarithmic
    if effect.own or reach is None or ("F" in text and not sizes["F"]):
        return Scale.by_bounds(parameter, logarithmic=logarithmic)
    text = re.sub(r"\b[DZFT]\b", lambda found: f"({sizes[found[0]]})", text)
    lower = -reach if parameter.lower < 0 else 0.0
    if parameter.searched:  # as many decades as between its bounds
        lower = reach * parameter.lower / parameter.upper
    return Scale(parameter.in_equations, text, lower, reach, logarithmic=logarithmic)

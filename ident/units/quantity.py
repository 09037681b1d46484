"""A value with its unit, as a user writes it, to a float in SI.

A unit is names joined by ``*``, ``/`` and powers: ``mm^2``, ``N*s/m``, ``m^3/(s*kPa)``. Only single names are given to
pint, so no input reaches an evaluator; :mod:`ident.units.names` holds every name there is.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from typing import Any

from ident.errors import Unusable
from ident.units.decimal_sign import with_point
from ident.units.grammar import Powers, powers_of
from ident.units.names import ANGLES, BASE, DERIVED, PREFIXES
from ident.units.nearest import nearest
from ident.units.usual import USUAL
from ident.words.nearest import quoted

DIMENSIONS = {
    "length": "m",
    "area": "m^2",
    "volume": "m^3",
    "mass": "kg",
    "time": "s",
    "frequency": "1/s",
    "velocity": "m/s",
    "angular velocity": "rad/s",
       "acceleration": "m/s^2", "force": "N", "pressure": "Pa", "stiffness": "N/m", "damping": "N*s/m", "current": "A",
    "voltage": "V", "temperature": "K", "flow": "m^3/s", "dimensionless": "1", "per sample": "1/sample",
    "angle": "rad", "torque": "N*m", "power": "W",
}  # fmt: skip
"""Dimension by name to its SI unit; an SI unit (``m^4/s``) may stand wherever a dimension's name may."""

_NAMED = {unit: name for name, unit in DIMENSIONS.items()}
"""The name of each dimension by its SI unit."""

_WRITTEN = {
    "frequency": "Hz",
    "area": "mm^2",
    "length": "mm",
    "volume": "cm^3",
    "pressure": "bar",
    "flow": "l/min",
    "temperature": "degC",
    "angle": "deg",
}
"""The unit of an example where the SI unit would make an absurd one of a bench's number: 640 mm^2, not 640 m^2."""

_USUAL = {"time": "ms", **_WRITTEN}
"""A unit that benches use for a dimension, in addition to its SI unit."""

PRINTED_Z0 = "m^3/(s*kPa) as printed"
"""The unit that Qian et al. 2014 print beside Z0, which is not its unit."""

PRINTED_Z0_FACTOR = 0.0254 * 6.894757293168362
"""m⁴/s for one `PRINTED_Z0`: the paper divided a number in in⁴/s by (in³/psi) per (m³/kPa), so what was left out is
one inch (0.0254 m) times one psi (6.894757 kPa). 1.48e-5 as printed is 2.592e-6 m⁴/s."""

NUMBER_AND_REST = re.compile(r"^\s*[+-]?[\d.,]+(?:[eE][+-]?\d+)?")
"""What stands before a unit, whatever its decimal sign."""
NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*", re.DOTALL)
LONGEST = 80


@dataclass(frozen=True)
class Scale:
    """SI value = `factor` × value + `offset`, in the SI unit `unit`."""

    factor: float
    offset: float
    unit: str


@dataclass(frozen=True)
class Atom:
    """One unit name: its factor and offset to SI, and the powers of its dimensions."""

    factor: float
    offset: float
    dimensions: tuple[tuple[str, float], ...]


def si_unit(dimension: str) -> str:
    """The SI unit of a dimension's name ("length" → "m"); a unit is returned as it is."""
    return DIMENSIONS.get(dimension, dimension)


def split(text: object, where: str) -> tuple[float, str]:
    """The number and the unit's name of ``"497 mm^2"`` or ``"3,6 ms"``; the unit is empty where there is none.

    Raises Unusable: ``not-a-quantity`` for no number, ``not-finite`` for one out of range, ``decimal-comma``.
    """
    found = NUMBER.fullmatch(with_point(str(text), where)) if isinstance(text, str | int | float) else None
    if isinstance(text, bool) or found is None or len(str(text)) > LONGEST:
        raise Unusable("not-a-quantity", f"{shown(text)} is not a number with a unit", where, "write it as 497 mm^2")
    number = float(found[1])
    if not math.isfinite(number):
        raise Unusable("not-finite", f"{shown(text)} is out of range", where, "give a finite number")
    return number, found[2]


def quantity(text: object, dimension: str, where: str) -> float:
    """The SI value of a number with its unit, for example ``quantity("497 mm^2", "area", "piston_area")`` → 4.97e-4.

    `dimension` is a name of DIMENSIONS or an SI unit; `where` names the field in errors. Raises Unusable:
    ``not-a-quantity``, ``missing-unit``, ``unknown-unit``, ``wrong-dimension``, ``not-finite``.
    """
    number, unit = split(text, where)
    if not unit and si_unit(dimension) != "1":
        example = f"add one, for example {shown(text)} {_WRITTEN.get(dimension, si_unit(dimension))}"
        raise Unusable("missing-unit", f"{shown(text)} has no unit", where, example)
    scale = unit_scale(unit or "1", dimension, where)
    # Decimal, so that 497 mm^2 is exactly the float 4.97e-4 that a program would compare it with
    value = float(Decimal(repr(number)) * Decimal(repr(scale.factor))) + scale.offset
    if not math.isfinite(value):
        raise Unusable("not-finite", f"{shown(text)} is out of range", where, "give a finite number")
    return value


def parameter_value(text: str | float, unit: str, where: str) -> float:
    """As :func:`quantity`, but a bare number is taken in the parameter's own SI unit: for settings, not for data."""
    number, given = split(text, where)
    return quantity(text, unit, where) if given else number


def printed_notice(text: object) -> str | None:
    """What to tell a user who wrote a quantity in the printed unit of Z0; None for any other quantity."""
    if not isinstance(text, str) or not is_printed(NUMBER_AND_REST.sub("", text).strip()):
        return None
    found = NUMBER.fullmatch(with_point(text, "Z0"))
    if found is None:
        return None
    value = float(found[1]) * PRINTED_Z0_FACTOR
    return f"Z0 = {shown(text)} was converted to {value:.4g} m^4/s: the printed unit is not that of Z0"


def unit_scale(unit: str, dimension: str, where: str) -> Scale:
    """How to bring values in `unit` to SI. Raises Unusable: ``unknown-unit``, ``wrong-dimension``."""
    target = si_unit(dimension)
    if is_printed(unit) and target == "m^4/s":
        return Scale(PRINTED_Z0_FACTOR, 0.0, target)
    if dimension == "acceleration" and unit in ("g", "G"):
        unit = "g_n"  # gram has no business here
    if dimension == "temperature" and unit in ("C", "F"):
        unit = f"deg{unit}"  # nor have coulomb and farad
    powers = known_powers(unit, where, target)
    if target == "rad/s" and powers == {"min": -1.0}:
        powers = {"rev": 1.0, "min": -1.0}  # of a speed of rotation 1/min counts turns
    if target == "N" and powers == {"lb": 1.0}:
        powers = {"lbf": 1.0}  # the pounds of a load cell are a force, as those of a torque are
    # pint calls an angle a plain number; so may a user who writes a phase, but no channel does
    apart = target in ("1/s", "rad/s", "rad") or dimension == "dimensionless"
    turns = apart and bool(ANGLES & set(powers)) != target.startswith("rad")
    if turns or shape(powers, where, target) != shape(known_powers(target, where), where):
        what = f"{unit!r} is not a unit of {described(dimension)}"
        raise Unusable("wrong-dimension", what, where, remedy(unit, target))
    return Scale(*factor_and_offset(powers, where), target)


SI_UNITS = (
    *DIMENSIONS.values(), "m^4/s", "m^3/(s*Pa)", "m^3/Pa", "1/m", "1/m^2", "s/m", "s^2/m^2", "N/m^3", "N*s^2/m^2",
    "m/Pa", "1/Pa", "s/m^3", "m/N", "1/N", "m/(N*s)", "1/s^2", "kg/s^2",
)  # fmt: skip
"""SI units as the program writes them."""


def si_scale(unit: str, where: str) -> Scale:
    """How to bring differences in `unit` to SI, with the SI unit's usual name. Raises Unusable: ``unknown-unit``."""
    powers = known_powers(unit, where)
    wanted = shape(powers, where)
    same = (name for name in SI_UNITS if shape(known_powers(name, where), where) == wanted)
    found = next(same, "*".join(f"{_BASE_UNITS.get(base, base)}^{power:g}" for base, power in wanted))
    if found == "1/s" and ANGLES & set(powers):
        found = "rad/s"
    return Scale(factor_and_offset(powers, where)[0], 0.0, found)


_BASE_UNITS = {"[length]": "m", "[mass]": "kg", "[time]": "s", "[current]": "A", "[temperature]": "K"}


def is_printed(unit: str) -> bool:
    """True for the printed unit of Z0, however it is spaced."""
    return unit.replace(" ", "") == PRINTED_Z0.replace(" ", "")


def remedy(unit: str, target: str) -> str:
    """What to write instead."""
    if target == "m^4/s" and "Pa" in unit:
        return f"use m^4/s, or the paper's own '{PRINTED_Z0}'"
    if target == "1":
        return "write a plain number"
    kind = _NAMED.get(target)
    usual = _USUAL.get(kind or "", target)
    like = "" if usual == target else f", such as {usual}"
    return f"use {target} or another unit of {kind}{like}" if kind else f"use {target} or a unit of the same kind"


def described(dimension: str) -> str:
    """A dimension in words."""
    return dimension if dimension in DIMENSIONS else _NAMED.get(dimension, f"the same kind as {dimension}")


def shown(text: object) -> str:
    """A user's input for a message, short."""
    line = " ".join(str(text).split())
    return line if len(line) <= LONGEST else line[: LONGEST - 1] + "…"


def known_powers(unit: str, where: str, target: str = "") -> Powers:
    """The powers of the names in a unit, where one of the kind of `target` is wanted. Raises ``unknown-unit``."""
    powers = powers_of(unit) if len(unit) <= LONGEST else None
    if powers is None:
        raise not_known(unit, where, target)
    return powers


def is_known_unit(unit: str) -> bool:
    """Whether every name in a unit is known here."""
    powers = powers_of(unit) if len(unit) <= LONGEST else None
    return powers is not None and all(known_atom(name) is not None for name in powers)


def not_known(unit: str, where: str, target: str = "") -> Unusable:
    """The error for a unit that cannot be read, with the nearest one of the kind that is wanted, else of all."""
    near = nearest(unit, target)
    hint = f"did you mean {quoted(near)}?" if near else "write it as mm, N*s/m or m^3/(s*kPa)"
    return Unusable("unknown-unit", f"unit {shown(unit)!r} is not known", where, hint)


def shape(powers: Powers, where: str, target: str = "") -> tuple[tuple[str, float], ...]:
    """The dimensions of a unit with their powers, sorted."""
    total: dict[str, float] = {}
    for name, power in powers.items():
        for base, own in atom(name, where, target).dimensions:
            total[base] = total.get(base, 0.0) + power * own
    return tuple(sorted((base, power) for base, power in total.items() if power))


def factor_and_offset(powers: Powers, where: str) -> tuple[float, float]:
    """Factor to SI; the offset only where a temperature stands alone, elsewhere a degree is a difference."""
    try:
        factor = math.prod(atom(name, where).factor ** power for name, power in powers.items())
    except OverflowError:
        factor = math.inf
    if not 0.0 < factor < math.inf:
        raise Unusable("unknown-unit", "the powers of the unit are out of range", where, "write a unit of the bench")
    if len(powers) == 1 and next(iter(powers.values())) == 1.0:
        return factor, atom(next(iter(powers)), where).offset
    return factor, 0.0


@cache
def registry() -> Any:
    """Pint with our units only; built once, when first needed, because importing pint takes most of a second."""
    import pint  # noqa: PLC0415

    built: Any = pint.UnitRegistry(None)
    built.load_definitions((PREFIXES + BASE + DERIVED).strip().splitlines())
    return built


def known_atom(name: str) -> Atom | None:
    """One unit name; None where it is none."""
    if name in USUAL:
        factor, dimensions = USUAL[name]
        return Atom(factor, 0.0, dimensions)
    return atom_of_pint(name)


@cache
def atom_of_pint(name: str) -> Atom | None:
    """One unit name as pint has it; None where it does not know it."""
    import pint  # noqa: PLC0415

    try:
        unit = registry().parse_units(name)
        one, zero = (registry().Quantity(number, unit).to_root_units().magnitude for number in (1.0, 0.0))
    except (pint.errors.PintError, AttributeError, ValueError):
        return None
    dimensions = tuple((str(base), float(power)) for base, power in unit.dimensionality.items())
    return Atom(float(one - zero), float(zero), dimensions)


def atom(name: str, where: str, target: str = "") -> Atom:
    """As :func:`known_atom`, an unknown name being an error."""
    found = known_atom(name)
    if found is None:
        raise not_known(name, where, target)
    return found

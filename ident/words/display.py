"""Display units: a lab reads pressure in bar and flow in l/min. What is stored, and what JSON holds, stays in SI."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar

from ident.errors import Unusable
from ident.words.nearest import did_you_mean

CHOICES: Mapping[str, tuple[str, Mapping[str, float]]] = {
    "pressure": ("Pa", {"bar": 1e5, "psi": 6894.757293168362}),
    "flow": ("m^3/s", {"l/min": 1e-3 / 60, "gal/min": 3.785411784e-3 / 60}),
    "length": ("m", {"in": 0.0254}),
    "velocity": ("m/s", {"in/s": 0.0254}),
    "area": ("m^2", {"cm^2": 1e-4, "in^2": 0.0254**2}),
    "volume": ("m^3", {"cm^3": 1e-6, "l": 1e-3, "in^3": 0.0254**3}),
    "force": ("N", {"lbf": 4.4482216152605}),
    "mass": ("kg", {"lb": 0.45359237}),
}
"""Of each quantity its SI unit, and the units that can be shown in its place with their size in SI."""
_OF_UNIT = {unit: (si, size) for si, units in CHOICES.values() for unit, size in units.items()}
_shown: ContextVar[Mapping[str, tuple[float, str]]] = ContextVar("display units")


def displayed(unit: str) -> tuple[float, str]:
    """How much of an SI unit the unit shown in its place is, and that unit: (1e5, "bar") of "Pa"; else (1.0, unit)."""
    return _shown.get({}).get(unit, (1.0, unit))


def display_units() -> tuple[str, ...]:
    """The units that are shown in place of SI units, by name."""
    return tuple(sorted(unit for _, unit in _shown.get({}).values()))


def known(text: str) -> tuple[str, ...]:
    """The display units in a text that separates them by commas, one a quantity; what is none is left out."""
    named = [unit for unit in text.split(",") if unit in _OF_UNIT]
    return tuple({_OF_UNIT[unit][0]: unit for unit in named}.values())


def show_in(units: Iterable[str]) -> None:
    """Show quantities in these units from here on. Raises Unusable for an unknown unit, and for two of one quantity."""
    _shown.set(_checked(units))


@contextmanager
def displaying(units: Iterable[str]) -> Iterator[None]:
    """Show quantities in these units while the block runs. Raises Unusable as :func:`show_in`."""
    token = _shown.set(_checked(units))
    try:
        yield
    finally:
        _shown.reset(token)


def _checked(units: Iterable[str]) -> dict[str, tuple[float, str]]:
    found: dict[str, tuple[float, str]] = {}
    for unit in units:
        if unit not in _OF_UNIT:
            remedy = did_you_mean(unit, _OF_UNIT)
            raise Unusable("unknown-display-unit", f"{unit!r} is no display unit", "display units", remedy)
        si, size = _OF_UNIT[unit]
        if si in found and found[si][1] != unit:
            what = f"{found[si][1]} and {unit} are units of one quantity"
            raise Unusable("two-display-units", what, "display units", "choose one of them")
        found[si] = (size, unit)
    return found

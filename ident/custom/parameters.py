"""The parameters of a user's effect, from entries with a unit, to SI."""

from __future__ import annotations

import keyword
import re
from collections.abc import Mapping
from typing import Any

from ident.errors import Unusable
from ident.parameter import Parameter, Starts
from ident.readers.typed_fields import Fields
from ident.units.quantity import quantity, shown, si_scale, split

_KEYS = ("name", "symbol", "unit", "lower", "upper", "value", "meaning", "start")
_STARTS = {start.value: start for start in Starts}
_MOST = 6  # shapes
_ROUNDING = 1e-12  # relative, by which arithmetic of some steps may write a value beyond its bound
_WIDE = 10.0  # by which factor a shape that is given as one value may be searched to either side


def strength_of(fields: Fields) -> Parameter:
    """The strength: 0 where the effect is off, and 0 within its bounds. Raises Unusable."""
    data = fields.need("strength", "write strength: {symbol: h, unit: mm, lower: 0, upper: 1}")
    entry = Fields(data, "strength", tuple(key for key in _KEYS if key != "value"))
    found = parameter_of(entry, symbol_of(entry, entry.need("symbol", "write symbol: h")), default=0.0)
    if not found.lower <= 0.0 <= found.upper:
        raise Unusable("bad-strength", "0 is not within the bounds", "strength", "let lower be 0, the effect off")
    return found


def shapes_of(fields: Fields) -> tuple[Parameter, ...]:
    """The other parameters: a mapping of names to entries or values, a list of entries, or one entry."""
    data = fields.data.get("shape")
    if data is None or data == {}:
        return ()
    if isinstance(data, Mapping) and {"symbol", "unit"} <= data.keys():
        data = [data]
    if isinstance(data, list):
        data = {str(one.get("name", one.get("symbol", ""))) if isinstance(one, Mapping) else "": one for one in data}
    if not isinstance(data, Mapping) or len(data) > _MOST:
        raise Unusable("not-a-mapping", "no list of shape parameters", "shape", f"write T: 20 ms, at most {_MOST}")
    return tuple(_shape(str(name), entry) for name, entry in data.items())


def symbol_of(entry: Fields, given: object) -> str:
    """A symbol that can stand in an equation. Raises Unusable."""
    text = str(given)
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*", text) or len(text) > 30 or keyword.iskeyword(text):
        raise Unusable(
            "bad-name",
            f"{shown(text)!r} is not a symbol",
            entry.place("symbol"),
            "give letters and digits, a letter first",
        )
    return text


def _shape(name: str, data: Any) -> Parameter:
    if isinstance(data, Mapping):
        entry = Fields(data, f"shape {name}", _KEYS)
        return parameter_of(entry, symbol_of(entry, data.get("symbol") or name), name=name)
    number, unit = split(data, f"shape {name}")
    scale = si_scale(unit or "1", f"shape {name}")
    value = number * scale.factor
    lower, upper = sorted((value / _WIDE, value * _WIDE)) if value else (-1.0, 1.0)
    symbol = symbol_of(Fields({}, f"shape {name}", _KEYS), name)
    return Parameter(symbol, symbol, scale.unit, lower, upper, value, f"shape {name}")


def _on_bounds(value: float, lower: float, upper: float) -> float:
    """The value, put onto a bound beyond which it lies by no more than rounding: a refit writes what ended there so."""
    if lower <= value <= upper:
        return value
    nearest = min(max(value, lower), upper)
    return nearest if abs(value - nearest) <= _ROUNDING * abs(nearest) else value


def parameter_of(entry: Fields, symbol: str, default: float | None = None, name: str = "") -> Parameter:
    """A parameter from an entry with unit, bounds and value; without a value in the middle. Raises Unusable.

    A shape whose `start` is stated is searched with the strength.
    """
    unit = entry.text("unit")
    if not unit:
        raise Unusable("missing-unit", "no unit", entry.where, "write unit: mm, or unit: 1 for a plain number")
    scale = si_scale(unit, entry.place("unit"))

    def si(key: str) -> float:
        number, given = split(entry.data[key], entry.place(key))
        return quantity(entry.data[key], scale.unit, entry.place(key)) if given else number * scale.factor

    for key in ("lower", "upper"):
        entry.need(key, f"write {key}: 0, in {unit}")
    lower, upper = si("lower"), si("upper")
    value = default if default is not None else si("value") if "value" in entry else 0.5 * (lower + upper)
    value = _on_bounds(value, lower, upper)
    if not lower <= value <= upper:
        raise Unusable("outside-bounds", f"{value:g} {scale.unit} is outside its bounds", entry.where, "widen them")
    own = symbol_of(entry, entry.text("name") or name or symbol)
    start = _STARTS[entry.choice("start", tuple(_STARTS), Starts.ALONG_RANGE.value)]
    searched = "start" in entry and default is None and start not in (Starts.STROKE_MIDDLE, Starts.AS_KNOWN)
    meaning = entry.text("meaning", f"{entry.where} {symbol}")
    return Parameter(own, symbol, scale.unit, lower, upper, value, meaning, searched=searched, start=start)

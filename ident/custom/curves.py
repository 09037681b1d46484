"""A curve in a user's effect: its values at knots of one signal are shapes, and between them it is drawn.

    curve: {symbol: h, of: P, knots: [-5 MPa, 0 MPa, 5 MPa], values: [1, 0, 1], unit: 1, lower: 0, upper: 2}

The values are called h_1, h_2, …; `draw: lines` (as usual) joins them by straight lines, `draw: monotone` by cubics
without overshoot; beyond the first and the last knot the curve goes on straight.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from ident.custom.names import Line
from ident.custom.parameters import parameter_of, symbol_of
from ident.equations.grammar import TABLES
from ident.errors import Unusable
from ident.parameter import Parameter
from ident.readers.typed_fields import Fields
from ident.units.quantity import si_scale, split

MOST = 12
"""Knots of a curve."""
_KEYS = ("symbol", "of", "knots", "values", "unit", "lower", "upper", "draw", "meaning")
_EXAMPLE = "curve: {symbol: h, of: P, knots: [0 MPa, 5 MPa], values: [0, 1], unit: 1, lower: 0, upper: 2}"


def curve_of(fields: Fields) -> tuple[Line, tuple[Parameter, ...]] | None:
    """The line that draws the curve, and its values as parameters; None where there is none. Raises Unusable."""
    if "curve" not in fields:
        return None
    entry = Fields(fields.data["curve"], "curve", _KEYS)
    symbol = symbol_of(entry, entry.need("symbol", f"write {_EXAMPLE}"))
    of = symbol_of(entry, entry.need("of", "name the signal that it is a curve of: of: P"))
    knots = _knots(_listed(entry, "knots"))
    values = _listed(entry, "values")
    if len(values) != len(knots) or not 2 <= len(knots) <= MOST:
        raise Unusable(
            "bad-curve",
            f"{len(knots)} knots and {len(values)} values",
            "curve",
            f"give as many values as knots, 2 to {MOST}",
        )
    if any(b <= a for a, b in pairwise(knots)):
        raise Unusable("bad-curve", "the knots do not rise", "curve knots", "give them from the least to the largest")
    names = [f"{symbol}_{number}" for number in range(1, len(knots) + 1)]
    parameters = tuple(_value(entry, name, value) for name, value in zip(names, values, strict=True))
    table = ", ".join(f"{knot!r}, {name}" for knot, name in zip(knots, names, strict=True))
    drawn = f"{entry.choice('draw', TABLES, TABLES[0])}({of}, {table})"
    return Line("curve of", symbol, drawn, 0, drawn, is_written=False), parameters


def _listed(entry: Fields, key: str) -> list[Any]:
    found = entry.need(key, f"write {_EXAMPLE}")
    if not isinstance(found, list):
        raise Unusable("bad-curve", f"{key} is not a list", f"curve {key}", f"write {_EXAMPLE}")
    return found


def _knots(given: list[Any]) -> list[float]:
    """In SI; a bare number is in SI already."""
    parts = [split(value, "curve knots") for value in given]
    scales = [si_scale(unit or "1", "curve knots") for _, unit in parts]
    units = {scale.unit for scale, (_, unit) in zip(scales, parts, strict=True) if unit}
    if len(units) > 1:
        raise Unusable(
            "bad-curve", f"knots in {' and in '.join(sorted(units))}", "curve knots", "give them in one unit"
        )
    return [float(number * scale.factor) for (number, _), scale in zip(parts, scales, strict=True)]


def _value(entry: Fields, name: str, value: Any) -> Parameter:
    data = {key: entry.data[key] for key in ("unit", "lower", "upper") if key in entry}
    return parameter_of(Fields({**data, "value": value}, f"curve value {name}", (*data, "value")), name)

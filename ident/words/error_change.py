"""What became of an error, in points and as a factor: a share of the error before says little where it is small.

From 12.1 to 0.5 % reads "−11.6 points, ÷ 24.2"; back again, which is 2320 % more of itself, "+11.6 points, × 24.2".
"""

from __future__ import annotations

import math

from ident.words.number import fixed, places, plain

_DECIMALS = 3  # of a point at most, as errors are printed
_LEAST = 1.005  # factor that is told: below it is 1.00


def error_change(before: float | None, after: float | None) -> str:
    """The change of an error (a fraction), or of an offset of any sign by its size; "–" where one is not known."""
    if before is None or after is None or not (math.isfinite(before) and math.isfinite(after)):
        return "–"
    first, last = abs(before), abs(after)
    points = 100 * (last - first)
    decimals = min(_DECIMALS, places(points, 3)) if points else _DECIMALS
    shown = fixed(abs(points), decimals)
    if not float(shown):
        return "0 points"
    said = f"{'−' if points < 0 else '+'}{shown} points"
    least, most = sorted((first, last))
    factor = most / least if least else math.inf
    if not _LEAST < factor < math.inf:
        return said
    return f"{said}, {'÷' if points < 0 else '×'} {plain(factor, 3)}"

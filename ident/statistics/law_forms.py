"""The forms that a parameter may have over a condition of the tests.

Over the oil temperature T (K), with T₀ the mean of the sets, a parameter y may follow the oil's viscosity or fluidity:

    Arrhenius   y = s exp(b (T₀/T − 1))
    Walther     y = s (ν/ν₀)^±1,  ν = exp(K (T₀/T)^m) − 0.7 mm²/s

The second is log log(ν + 0.7) = A − m log T (ASTM D341), with ν₀ at T₀. Over any condition x it may be linear,
y = s (1 + b z) or y = s + b z with z from −1 to 1 over the sets, or constant, y = s.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Curve = Callable[[Array, Array], Array]
"""Parameters (k,) and the abscissa (n,) → ln |y|, or y."""
_STEEPNESS = (2.0, 6.0)  # m of Walther's law: 2.5 to 4.5 for the oils of ASTM D341, with a margin
_EXPONENT = (math.log(1.7), math.log(1e6))  # K: a viscosity at T₀ of 1 mm²/s to 1 m²/s
_OFFSET = 0.7  # mm²/s, of ASTM D341 above 2 mm²/s
_STEEPEST = 0.999  # b of a line whose values keep their sign over the sets


@dataclass(frozen=True)
class LawForm:
    """A form: what a search for its parameters starts from (the first at the mean), and their bounds."""

    name: str
    formula: str
    curve: Curve
    starts: tuple[tuple[float, ...], ...]
    lower: tuple[float, ...]
    upper: tuple[float, ...]
    viscous: bool = False

    def abscissa(self, over: Sequence[float] | Array) -> Callable[[Array], Array]:
        """T₀/T of the forms of viscosity, z from −1 to 1 of the others, of sets at these conditions."""
        x = np.asarray(over, dtype=float)
        if self.viscous:
            mean = float(x.mean())
            return lambda given: mean / given
        middle, half = float(x.max() + x.min()) / 2, float(np.ptp(x)) / 2 or 1.0
        return lambda given: (given - middle) / half


def _line_of_shares(p: Array, z: Array) -> Array:
    found: Array = p[0] + np.log(np.maximum(1.0 + p[1] * z, 1.0 - _STEEPEST))
    return found


def _walther(p: Array, u: Array) -> Array:
    """ln s ± ln ν/ν₀, of the sign of the second parameter."""
    sign, exponent = math.copysign(1.0, p[1]), max(abs(p[1]), _EXPONENT[0])
    found: Array = p[0] + sign * (_log_viscosity(exponent * u ** p[2]) - _log_viscosity(np.array(exponent)))
    return found


def _log_viscosity(exponent: Array) -> Array:
    """ln(exp(exponent) − 0.7)."""
    found: Array = exponent + np.log1p(-np.minimum(_OFFSET * np.exp(-exponent), 0.999))
    return found


_INF = math.inf
CONSTANT = LawForm("constant", "y = s", lambda p, z: p[0] + 0.0 * z, ((0.0,),), (-_INF,), (_INF,))
LINE_OF_SHARES = LawForm(
    "linear", "y = s (1 + b z)", _line_of_shares, ((0.0, 0.0),), (-_INF, -_STEEPEST), (_INF, _STEEPEST)
)
LINE = LawForm("linear", "y = s + b z", lambda p, z: p[0] + p[1] * z, ((0.0, 0.0),), (-_INF, -_INF), (_INF, _INF))
ARRHENIUS = LawForm(
    "Arrhenius",
    "y = s exp(b (T₀/T − 1))",
    lambda p, u: p[0] + p[1] * (u - 1.0),
    ((0.0, 0.0),),
    (-_INF, -_INF),
    (_INF, _INF),
    viscous=True,
)
WALTHER = LawForm(
    "Walther",
    "y = s (ν/ν₀)^±1, ν = exp(K (T₀/T)^m) − 0.7 mm²/s",
    _walther,
    ((0.0, 4.0, 3.6), (0.0, -4.0, 3.6)),
    (-_INF, -_EXPONENT[1], _STEEPNESS[0]),
    (_INF, _EXPONENT[1], _STEEPNESS[1]),
    viscous=True,
)


def forms_of(temperature: bool, relative: bool) -> tuple[LawForm, ...]:
    """Those that are tried: of values of one sign over a temperature those of viscosity, too."""
    if not relative:
        return (CONSTANT, LINE)
    return (CONSTANT, LINE_OF_SHARES, *((ARRHENIUS, WALTHER) if temperature else ()))

"""A term that may be missing at a place: its equation, its shapes, its samples on the signals of a run."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ident.diagnosis.criteria import CRITERIA
from ident.equations.equation import Equation
from ident.equations.interpolation import interpolated
from ident.units.grammar import Powers, powers_of

Array = NDArray[np.float64]
Signals = Mapping[str, Array]
CURVE = "h"
"""The symbol of a free curve in a term."""
STATE = "z"
"""The symbol of a term's own state."""
LIMIT = "Ff"
"""The signal of the largest dry friction, in machines whose load sticks."""


@dataclass(frozen=True)
class Shape:
    """A number within a term: its symbol, its value in the search, its unit, and whether a refit moves it.

    A refit moves it within its bounds where they are given, else by the factor `spread` to either side.
    """

    symbol: str
    value: float
    unit: str
    free: bool = True
    spread: float = CRITERIA.terms.spread
    lower: float | None = None
    upper: float | None = None

    @property
    def bounds(self) -> tuple[float, float]:
        """The bounds within which a refit moves it."""
        low, high = sorted((self.value / self.spread, self.value * self.spread))
        return low if self.lower is None else self.lower, high if self.upper is None else self.upper


@dataclass(frozen=True)
class Curve:
    """A curve h of a signal through knots in a term, with its values at the knots in the search.

    The value at the knot `held` is fixed at 1, because the strength is its size; a refit moves the other values.
    """

    of: str
    knots: tuple[float, ...]
    values: tuple[float, ...]
    held: int = 0

    def samples(self, signals: Signals) -> Array:
        """Linear interpolation between the knots, and linear extrapolation beyond them."""
        table = np.ravel(np.column_stack([self.knots, self.values])).tolist()
        return np.asarray(interpolated("lines", signals[self.of], *table))


@dataclass(frozen=True)
class Term:
    """A term at a place: `at` is the signal that it adds to, `text` its equation, `unit` its unit.

    `kind` names its form and `of` the signals that it reads; `memory` are equations of its own that come before it,
    `state` is the rate of a state z of its own. With `in_time` its size depends on how fast its signals move.
    `worked_out` gives its samples where the equation alone does not. They go `through` another signal than `at` where
    `at` is multiplied and a small change of it acts as an addition to that signal. For dry friction of the moving mass
    `limit` is its largest force: such a term sticks. With a `curve` the equation has h.
    """

    place: str
    at: str
    text: str
    kind: str
    of: tuple[str, ...]
    unit: Powers
    shapes: tuple[Shape, ...] = ()
    memory: tuple[str, ...] = ()
    state: str = field(default="", kw_only=True)
    in_time: bool = field(default=False, kw_only=True)
    through: str = field(default="", kw_only=True)
    worked_out: Callable[[Signals, float], Array] | None = field(default=None, compare=False, repr=False)
    limit: str = ""
    curve: Curve | None = None

    def samples(self, signals: Signals, rate: float) -> Array:
        """The term on the signals of a run, (n,)."""
        if self.worked_out is not None:
            return self.worked_out(signals, rate)
        known = {**signals, **{shape.symbol: shape.value for shape in self.shapes}}
        if self.curve is not None:
            known[CURVE] = self.curve.samples(signals)
        value = Equation(f"d = {self.text}").value(known)
        return np.broadcast_to(np.asarray(value, dtype=np.float64), next(iter(signals.values())).shape)

    @property
    def path(self) -> str:
        """The signal from which its samples go to the output."""
        return self.through or self.at

    @property
    def free_shapes(self) -> int:
        """The number of its shapes that a refit moves."""
        return sum(shape.free for shape in self.shapes)

    @property
    def fitted(self) -> int:
        """The number of its shapes and values of a curve that a refit moves."""
        return self.free_shapes + (len(self.curve.knots) - 1 if self.curve else 0)

    @property
    def form(self) -> tuple[str, str, tuple[str, ...]]:
        """The properties that are equal in terms that differ only by the first values of their shapes."""
        return self.at, self.kind, self.of


def multiplied(a: Powers, b: Powers, power: int) -> Powers:
    """The unit a, times b to a power."""
    found = dict(a)
    for name, of in b.items():
        found[name] = found.get(name, 0.0) + power * of
    return {name: of for name, of in found.items() if of}


def ratio(of: str, to: Powers) -> str:
    """The unit of one signal over that of a term, as text: "m^3*s^-1*Pa^-1"."""
    powers = multiplied(powers_of(of) or {}, to, -1)
    return "*".join(name if power == 1 else f"{name}^{power:g}" for name, power in powers.items()) or "1"

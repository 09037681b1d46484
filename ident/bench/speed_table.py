"""The speed characteristic as a table (Kononykhin, block c): straight lines or monotone cubics between its nodes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ident.bench.response import characteristics
from ident.cached import cached_property
from ident.equations.interpolation import piece_coefficients
from ident.errors import Unusable
from ident.stages.bench import FRACTIONS, node_names

Array = NDArray[np.float64]
KINDS = MONOTONE, LINES, SPLINE = ("monotone", "lines", "spline")


@dataclass(frozen=True)
class SpeedTable:
    """V0 = f(I − I0), without load and friction: speeds (m/s) at ±`fractions` of the rated current, 0 at 0.

    The two directions have tables of their own, because their gains differ (asymmetry) and meet in a corner.
    """

    forward: tuple[float, ...]
    back: tuple[float, ...]
    fractions: tuple[float, ...] = FRACTIONS
    kind: str = MONOTONE

    def __post_init__(self) -> None:
        rising = np.all(np.diff((0.0, *self.fractions)) > 0)
        if self.kind not in KINDS or not rising or not len(self.forward) == len(self.back) == len(self.fractions):
            what = f"{len(self.forward)} and {len(self.back)} speeds at {self.fractions}"
            remedy = "give a speed of each direction at rising currents above 0"
            raise Unusable("bad-table", what, "speed characteristic", remedy)

    @classmethod
    def straight(cls, gain: float, fractions: tuple[float, ...] = FRACTIONS, kind: str = "monotone") -> SpeedTable:
        """V0 = gain (I − I0), gain in m/s at rated current."""
        speeds = tuple(gain * fraction for fraction in fractions)
        return cls(speeds, tuple(-speed for speed in speeds), fractions, kind)

    @cached_property
    def nodes(self) -> Array:
        """0 and the fractions."""
        return np.array([0.0, *self.fractions])

    @cached_property
    def pieces(self) -> Array:
        """c0 … c3 of each piece of each side in |I − I0|; speeds of the second side counted positive: (2, n, 4)."""
        sides = [np.array([0.0, *self.forward]), -np.array([0.0, *self.back])]
        return np.array([piece_coefficients(self.nodes, side, self.kind) for side in sides])

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the speeds: V_p5 at +5 % of rated current, V_m5 at −5 %."""
        return node_names(self.fractions)

    def values(self) -> dict[str, float]:
        """The speeds by name."""
        return dict(zip(self.names, (*self.forward, *self.back), strict=True))

    def with_values(self, values: Mapping[str, float]) -> SpeedTable:
        """The table with other speeds, by name."""
        mine = self.values()
        changed = mine | {name: value for name, value in values.items() if name in mine}
        if changed == mine:
            return self
        speeds, half = tuple(changed[name] for name in self.names), len(self.fractions)
        return replace(self, forward=speeds[:half], back=speeds[half:])

    def speed(self, current: Array) -> Array:
        """f at currents relative to the zero shift, (n,)."""
        where = np.ascontiguousarray(current, dtype=float)
        return np.asarray(np.sign(where) * characteristics(where, self.nodes, self.pieces))

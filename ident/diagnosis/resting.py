"""Parameters that the data do not determine, held where few steps are needed, also where effects are added."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ident.fit.space import Space

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Resting:
    """Parameters that are held, each at a place (0 to 1) of its axis."""

    places: Mapping[str, float] = field(default_factory=dict)

    def held(self, space: Space, points: Array) -> Array:
        """Points (…, p) of the unit cube of a space, with the held parameters at their places."""
        places = [self.places.get(name, np.nan) for name in space.names]
        return np.where(np.isnan(places), points, places)

    def bounds(self, space: Space) -> tuple[Array, Array]:
        """The lower and upper ends of every axis, equal where a parameter is held."""
        count = len(space.axes)
        return self.held(space, np.zeros(count)), self.held(space, np.ones(count))

"""How the parameters of a machine, or of machines of one series, scatter between their parameter sets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.fit.result import FitResult

Array = NDArray[np.float64]
FEWEST = 3
"""Sets from which a scatter is taken."""


@dataclass(frozen=True)
class Scatter:
    """The relative deviations (n,) of each parameter from its mean over n sets, and what the sets are of, in words."""

    deviations: Mapping[str, tuple[float, ...]]
    of: str

    @classmethod
    def of_sets(cls, sets: Sequence[Mapping[str, float]], of: str) -> Scatter:
        """From the values of n sets, SI; of the parameters that are in every one, and not 0 in the mean.

        Raises Unusable for fewer than three sets.
        """
        if len(sets) < FEWEST:
            raise Unusable(
                "too-few",
                f"{len(sets)} parameter sets of {of}",
                "spread",
                f"give at least {FEWEST}, or state the spread",
            )
        shared = set.intersection(*(set(one) for one in sets))
        values = {name: np.array([one[name] for one in sets]) for name in sets[0] if name in shared}
        means = {name: float(found.mean()) for name, found in values.items()}
        return cls(
            {name: tuple((found / means[name] - 1.0).tolist()) for name, found in values.items() if means[name]}, of
        )

    @property
    def sets(self) -> int:
        """The number n of sets."""
        return len(next(iter(self.deviations.values()), ()))

    def __str__(self) -> str:
        return f"the scatter of {self.sets} parameter sets of {self.of}"

    def drawn(self, fit: FitResult, count: int, rng: np.random.Generator) -> dict[str, Array]:
        """`count` values of each parameter about that of a fit, as another set of the same kind would have it.

        With D (p, n) of deviations and g ~ N(0, 1) (n,) these are θ (1 + D g √(1 + 1/n)/√(χ²(n − 1))): the multivariate
        t distribution that predicts the next of n values (Gelman et al., Bayesian Data Analysis, section 3.6, there
        with n − 1 degrees of freedom for one parameter).
        """
        n = self.sets
        g = rng.standard_normal((count, n)) * np.sqrt((1 + 1 / n) / rng.chisquare(n - 1, count))[:, None]
        known = {name: off for name, off in self.deviations.items() if name in fit.parameters}
        return {name: fit.parameters[name].value * (1.0 + g @ np.array(off)) for name, off in known.items()}

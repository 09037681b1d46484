"""Which effects a periodic test allows: told by the reference before the program runs.

Every effect of the catalogue that applies at the machine is fitted to the output without noise, base and shape free:
d2 is the sum of the squares that the best fit leaves, over the variance of the noise. The class are all with d2 <= 20.
What the mean of the output alone would tell is left out, for the offset of a transducer is free: a static load, a bias.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tests.blind.periodic import Test
from tests.blind.periodic_candidates import APPLICABLE
from tests.blind.periodic_driven import Driven
from tests.blind.periodic_specimen import Specimen

ALIKE = 20.0  # d2 up to which a test cannot tell an effect from what is hidden
SHOWN = 60.0  # d2 that the base alone must leave
BEYOND = 1.1  # floors that the base alone must leave
LARGEST = 3  # names in a class


def fits(test: Test) -> Specimen | Driven:
    """The fits to a test's output without noise."""
    return Specimen(test) if test.machine == "specimen" else Driven(test)


@dataclass(frozen=True)
class Allowed:
    """What the reference decides of a test: d2 of the base alone ("") and of every effect."""

    d2: Mapping[str, float]
    samples: int

    @property
    def names(self) -> tuple[str, ...]:
        """The class."""
        return tuple(name for name, left in self.d2.items() if name and left <= ALIKE)

    @property
    def error(self) -> float:
        """That the base alone leaves, in floors."""
        return float(np.sqrt(1.0 + self.d2[""] / self.samples))

    @property
    def counts(self) -> str:
        """As what the test counts: "nothing", "hidden", or "dropped"."""
        if self.d2[""] <= ALIKE:
            return "nothing"
        shown = self.d2[""] >= SHOWN and self.error >= BEYOND and 0 < len(self.names) <= LARGEST
        return "hidden" if shown else "dropped"


def allowed(test: Test, among: Sequence[str] = ()) -> Allowed:
    """The class of a test, or its part `among` some effects; where the base alone will do nothing more is fitted."""
    of = fits(test)
    d2 = {"": of.d2("", ALIKE)}
    if d2[""] > ALIKE:
        d2 |= {name: of.d2(name, ALIKE) for name in among or APPLICABLE[test.machine]}
    return Allowed(d2, test.fitted)

"""The work that a drive does on what it moves."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ident.preprocessing.step import Threshold

Array = NDArray[np.float64]
GIVES_BACK = Threshold(
    -0.1,
    "of the product of the sizes of force and speed",
    "a mean of force times speed below it says that what is moved gives work back",
    "a spring or a mass alone takes no work in the mean, and noise neither: they stay around zero",
)


def mean_power(force: Array, speed: Array) -> float:
    """mean(F v) of the deviations from the means over the product of their sizes, −1 … 1."""
    return product(force - force.mean(), speed - speed.mean())


def product(force: Array, speed: Array) -> float:
    """mean(F v) over the product of the sizes, −1 … 1; 0 where one of them is zero throughout."""
    size = float(np.sqrt(np.mean(force**2) * np.mean(speed**2)))
    return float(np.mean(force * speed)) / size if size > 0 else 0.0

"""Steps of a search that are straight in the parameters, along axes that are logarithmic.

An axis runs from its lower to its upper bound, θ = lower (upper/lower)^u with s = ln(upper/lower), and a slope dy/du
tells how the output changes at first. How far it goes on like that is another thing: an output that is linear in θ, as
a force is in a mass or a stiffness, goes on so along θ and not along u. A step δ along u is taken as

    Δθ = s θ δ      u moves by ln(1 + s δ) / s

which is the same at first. So a mass that is next to nothing, and whose slope along u is, too, comes to its place in
one step, and along a valley of equal k − m ω² the steps stay in it. On a linear axis, s = 0, a step is itself.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_FARTHEST = 600.0
"""ln of the factor by which a parameter may rise in a step: beyond 709 it is no number. No answer depends on it."""


def led(point: Array, step: Array, lower: Array | float, upper: Array | float, spans: Array) -> tuple[Array, Array]:
    """The part of a step from a point (p,) that stays within the bounds of each axis, and where it leads: (p,), (p,).

    `spans` (p,) are s of each axis, 0 of a linear one.
    """
    logarithmic, s = spans > 0, np.where(spans > 0, spans, 1.0)
    down, up = lower - point, upper - point
    down = np.where(logarithmic, np.expm1(s * down) / s, down)
    up = np.where(logarithmic, np.expm1(np.minimum(s * up, _FARTHEST)) / s, up)
    within = np.clip(step, down, up)
    grown = np.maximum(np.where(logarithmic, s * within, 0.0), np.spacing(1.0) - 1.0)
    end = np.clip(point + np.where(logarithmic, np.log1p(grown) / s, within), lower, upper)
    return within, np.where(step <= down, lower, np.where(step >= up, upper, end))  # a bound exactly, no rounding near

"""How a controller does on the actuators that the fit leaves possible: draws from the fitted covariance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.fit.result import FitResult
from ident.hybrid.controller import SampledController
from ident.hybrid.sampled_loop import SampledLoop
from ident.linear import LinearModel

Array = NDArray[np.float64]
WITHIN = (1.0, 10.0)
"""dB and degrees, to 25 Hz, of what a draw may make of the controller's own response."""
HIGHEST = 25.0
"""Hz."""
SHOWN = 30.0
"""Hz: the end of the curves that are kept to be drawn."""
_POINTS = 60


@dataclass(frozen=True)
class Robustness:
    """Of `draws` plants how many are `stable` and how many stay `within` the limits; the band that 95 % are in.

    A draw is within them where its response is at most 1 dB and 10° from that of the wanted one, which is 1 where a
    path forward gives it and the nominal response for feedback alone. `frequency` (f,) in Hz; `magnitude` (dB) and
    `phase` (degrees) are (2, f), the lower and the upper edge.
    """

    draws: int
    stable: int
    within: int
    frequency: Array
    magnitude: Array
    phase: Array
    held: tuple[str, ...]


def undetermined(fit: FitResult) -> tuple[str, ...]:
    """Parameters that the data do not determine: they stay as fitted in every draw."""
    return tuple(name for name, one in fit.parameters.items() if not one.std_error and not one.fixed)


def robustness(
    controller: SampledController, delay: float, plants: Sequence[LinearModel], wanted: NDArray[np.complex128] | None,
    held: tuple[str, ...] = (),
) -> Robustness:  # fmt: skip
    """The controller in a loop with each of the plants; `wanted` is the response (f,) at :func:`frequencies`, or 1."""
    frequency = frequencies()
    target = np.ones(len(frequency), complex) if wanted is None else wanted
    stable, responses = 0, []
    for plant in plants:
        loop = SampledLoop(plant, controller, delay)
        if loop.stable:
            stable += 1
            responses.append(loop.response(frequency))
    found = np.array(responses).reshape(-1, len(frequency))
    ratio = found / target
    decibel, degrees = 20 * np.log10(np.abs(ratio)), np.degrees(np.angle(ratio))
    judged = frequency <= HIGHEST
    good = (np.abs(decibel[:, judged]) <= WITHIN[0]) & (np.abs(degrees[:, judged]) <= WITHIN[1])
    shown = (20 * np.log10(np.abs(found)), np.degrees(np.unwrap(np.angle(found), axis=1)))
    magnitude, phase = (_band(values, len(frequency)) for values in shown)
    return Robustness(len(plants), stable, int(good.all(axis=1).sum()), frequency, magnitude, phase, held)


def frequencies() -> Array:
    """Where responses are compared and drawn, Hz: 0.5 to 30."""
    return np.linspace(SHOWN / _POINTS, SHOWN, _POINTS)


def _band(values: Array, count: int) -> Array:
    return np.percentile(values, (2.5, 97.5), axis=0) if len(values) else np.full((2, count), np.nan)
